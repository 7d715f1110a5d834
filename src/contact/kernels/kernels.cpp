#include "kernels/kernels.h"

#include <cstdlib>
#include <string>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::contact::kernels {

extern const Kernels BASELINE;
#if defined(BLEM_SIM_X86_KERNELS)
extern const Kernels AVX2, AVX512;
#endif

const std::vector<const Kernels*>& availableKernels() {
  static const std::vector<const Kernels*> available = [] {
    std::vector<const Kernels*> found;
#if defined(BLEM_SIM_X86_KERNELS)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512bw")) {
      found.push_back(&AVX512);
    }
    if (__builtin_cpu_supports("avx2")) found.push_back(&AVX2);
#endif
    found.push_back(&BASELINE);
    return found;
  }();
  return available;
}

const Kernels& kernelsNamed(const char* name) {
  if (!name || !*name) return *availableKernels().front();
  std::string names;
  for (const Kernels* each : availableKernels()) {
    if (std::string(name) == each->name) return *each;
    names += (names.empty() ? "" : ", ") + std::string(each->name);
  }
  throw InputError("BLEM_SIM_KERNELS: '" + std::string(name) + "' does not run here; take one of " + names);
}

const Kernels& kernels() {
  static const Kernels& chosen = kernelsNamed(std::getenv("BLEM_SIM_KERNELS"));
  return chosen;
}

}  // namespace blem_sim::contact::kernels
