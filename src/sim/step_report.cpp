#include "blem_sim/sim/step_report.h"

namespace blem_sim::sim {

const std::array<const char*, static_cast<int>(Stage::COUNT)> STAGE_NAMES = {
    "sample_commands", "motor_torque", "broad_phase", "narrow_phase", "reduction", "solve", "step_guard", "sensors", "report"};

}  // namespace blem_sim::sim
