#include "blem_sim/sim/step_report.h"

namespace blem_sim {

const std::vector<std::string> STEP_STATUS_NAMES = {"STEP_SHORTENED",  "CONTACT_UNRELIABLE", "CONTACTS_REDUCED",
                                                    "SOLVER_TROUBLE",  "STATE_NOT_FINITE",   "EFFORT_SATURATED",
                                                    "JOINT_LIMIT_HIT", "ENERGY_GAINED",      "MOTION_TOO_FAST"};

const std::array<const char*, static_cast<int>(Stage::COUNT)> STAGE_NAMES = {
    "sample_commands", "motor_torque", "broad_phase", "narrow_phase", "reduction", "step_guard", "solve", "sensors", "report"};

}  // namespace blem_sim
