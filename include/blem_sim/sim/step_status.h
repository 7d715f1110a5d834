// Bits of a step's status, what each means, and the cure: messages, log and diagnostics take their words from here.
#pragma once

#include <cstdint>

namespace blem_sim::sim {

/** Bits of StepReport::status. STEP_STATUS says what each means. */
enum StepStatus : std::uint32_t {
  STEP_OK = 0,
  STEP_SHORTENED = 1u << 0,
  CONTACT_UNRELIABLE = 1u << 1,
  CONTACTS_REDUCED = 1u << 2,
  SOLVER_TROUBLE = 1u << 3,
  STATE_NOT_FINITE = 1u << 4,
  EFFORT_SATURATED = 1u << 5,
  JOINT_LIMIT_HIT = 1u << 6,
  ENERGY_GAINED = 1u << 7,
  MOTION_TOO_FAST = 1u << 8,
};

struct StatusBit {
  StepStatus bit;
  const char* name;  ///< in reports and messages
  const char* meaning;
  const char* cure;  ///< settings to change; empty if nothing need be done
};

/** In bit order. msg/StepReport.msg repeats it. */
inline constexpr StatusBit STEP_STATUS[] = {
    {STEP_SHORTENED, "STEP_SHORTENED",
     "bodies could use up a boundary layer, or light links in tension swing too fast, the step was made in parts",
     "raise boundary_width, give the links armature or damping, or lower time_step"},
    {CONTACT_UNRELIABLE, "CONTACT_UNRELIABLE", "bare meshes cross, or crossed within the step, forces there are a guess",
     "raise boundary_width, lower time_step, or start from a better pose"},
    {CONTACTS_REDUCED, "CONTACTS_REDUCED", "contacts were left out, wrench_error tells by how much wrenches may be off",
     "raise max_contacts_per_robot or max_contacts_per_object if it is too much"},
    {SOLVER_TROUBLE, "SOLVER_TROUBLE", "contact forces are off by over 1 % of the largest, or velocities by 0.01",
     "lower time_step or have fewer contacts; with world_step or quick_step raise solver/cfm"},
    {STATE_NOT_FINITE, "STATE_NOT_FINITE", "a state stopped being finite, the last finite one was restored and the simulation paused",
     "lower time_step or gains, then reset_world and unpause_physics"},
    {EFFORT_SATURATED, "EFFORT_SATURATED", "a motor is at its effort limit", "raise effort_limits or move more slowly"},
    {JOINT_LIMIT_HIT, "JOINT_LIMIT_HIT", "a joint is at its limit", ""},
    {ENERGY_GAINED, "ENERGY_GAINED", "bodies that touch or are jointed gained energy out of nothing",
     "lower time_step; where motors or bounces drive it, softer gains or a lower restitution"},
    {MOTION_TOO_FAST, "MOTION_TOO_FAST", "a motion was too fast for the step, velocity products changed too much within it",
     "lower time_step"},
};

}  // namespace blem_sim::sim
