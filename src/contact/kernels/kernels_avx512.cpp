#include "kernels/kernels_code.h"

namespace blem_sim::contact::kernels {
extern const Kernels AVX512;
const Kernels AVX512 = BLEM_SIM_KERNEL_TABLE("avx512");
}  // namespace blem_sim::contact::kernels
