// Readings of a solved island: forces of its contacts, efforts of its joints.
#pragma once

#include <vector>

#include "island/island.h"
#include "scene/step_memory.h"

namespace blem_sim::dynamics {

/** Fills the result's contact_forces and apparent_work of the island's contacts. */
void readContacts(const StepInput& input, const Island& island, SolveResult* result);

/** Fills the result's motor_efforts and axis_efforts of the island's joints, which were set to zero. @param records of all joints, by slot:
 *  efforts that the next step begins with, out */
void readJoints(const StepInput& input, const Island& island, SolveResult* result, std::vector<JointRecord>* records);

}  // namespace blem_sim::dynamics
