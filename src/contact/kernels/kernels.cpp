#include "kernels.h"

#include <cstdlib>
#include <string>

namespace blem_sim::kernels {

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

const Kernels& kernels() {
  static const Kernels& chosen = [&]() -> const Kernels& {
    const char* forced = std::getenv("BLEM_SIM_KERNELS");
    for (const Kernels* each : availableKernels())
      if (forced && std::string(forced) == each->name) return *each;
    return *availableKernels().front();
  }();
  return chosen;
}

}  // namespace blem_sim::kernels
