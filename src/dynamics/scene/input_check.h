// Input checks of the world: numbers that are finite, and in their ranges.
#pragma once

#include "blem_sim/dynamics/world_types.h"

namespace blem_sim::dynamics {

/** Whether the contact is finite where it must be, has nothing negative that has no sign, and a normal of length 1 within 1e-3. */
bool isSound(const ContactConstraint& contact);
/** Whether the drive is finite, and no gain, friction or bound below 0. */
bool isSound(const JointDrive& drive);
bool isSound(const RootDrive& drive);
/** @throws InputError that names the field and the cure */
void checkJointNumbers(const JointSpec& joint, double position);

}  // namespace blem_sim::dynamics
