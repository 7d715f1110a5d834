#include "messages/status_text.h"

#include "blem_sim/sim/step_report.h"

namespace blem_sim {

namespace {

struct Advice {
  StepStatus bit;
  const char* text;
};

constexpr Advice ADVICE[] = {
    {STEP_SHORTENED, "steps were halved to stay within the boundary layers: raise boundary_width or lower time_step"},
    {CONTACT_UNRELIABLE, "bare meshes cross, forces there are a guess: raise boundary_width, lower time_step, or start from a better pose"},
    {CONTACTS_REDUCED, "contacts were left out: raise max_contacts_per_robot or max_contacts_per_object if wrench_error is too much"},
    {SOLVER_TROUBLE,
     "contact forces are off by over 1 %: smaller time_step or fewer contacts; with world_step or quick_step raise solver/cfm"},
    {STATE_NOT_FINITE,
     "a state stopped being finite and the simulation was paused: lower time_step or gains, then reset_world and unpause_physics"},
    {EFFORT_SATURATED, "a motor is at its effort limit: raise effort_limits or move more slowly"},
    {ENERGY_GAINED,
     "bodies gained energy out of nothing: lower time_step; where motors or bounces drive it, softer gains or a lower restitution"},
    {MOTION_TOO_FAST, "a motion was too fast for the step: lower time_step"},
};

}  // namespace

std::vector<std::string> statusNames(std::uint32_t status) {
  std::vector<std::string> names;
  for (std::size_t bit = 0; bit < STEP_STATUS_NAMES.size(); ++bit) {
    if ((status & (1U << bit)) != 0) names.push_back(STEP_STATUS_NAMES[bit]);
  }
  return names;
}

std::vector<std::string> statusAdvice(std::uint32_t status) {
  std::vector<std::string> texts;
  for (const Advice& advice : ADVICE) {
    if ((status & advice.bit) != 0) texts.emplace_back(advice.text);
  }
  return texts;
}

}  // namespace blem_sim
