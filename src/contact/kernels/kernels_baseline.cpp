#include "kernels/kernels_code.h"

namespace blem_sim::contact::kernels {
extern const Kernels BASELINE;
const Kernels BASELINE = BLEM_SIM_KERNEL_TABLE("baseline");
}  // namespace blem_sim::contact::kernels
