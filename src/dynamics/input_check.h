// What the world takes: numbers that are numbers, and in their ranges.
#pragma once

#include "blem_sim/dynamics/world.h"

namespace blem_sim {

/** Finite where it must be, nothing negative that has no sign, and a normal of length 1 within 1e-3. */
bool isSound(const ContactConstraint& contact);
/** Finite, and no gain, friction or bound below 0. */
bool isSound(const JointDrive& drive);
/** @throws InputError that names the field and the cure */
void checkJointNumbers(const JointSpec& joint, double position);

}  // namespace blem_sim
