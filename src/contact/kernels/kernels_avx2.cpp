#include "kernels/kernels_code.h"

namespace blem_sim::contact::kernels {
extern const Kernels AVX2;
const Kernels AVX2 = BLEM_SIM_KERNEL_TABLE("avx2");
}  // namespace blem_sim::contact::kernels
