// Joints of the step problem while it is iterated, four at a time, each a lane's joint_term.h.
#pragma once

#include <vector>

#include "lanes/joint_term.h"
#include "lanes/lanes.h"

namespace blem_sim::dynamics {

struct JointBlock {
  int dof[LANES];  ///< -1: no joint
  Lanes motor_gain, motor_velocity, motor_bound, velocity_gain, min_velocity, max_velocity, viscous;
  Lanes dry_gain, dry_previous, dry_bound;  ///< the gains divided by their softness
  Lanes limit_gain, lower_velocity, lower_previous, upper_velocity, upper_previous;
  Lanes velocity, step;      ///< at the present iterate, and along the search direction
  Lanes impulse, stiffness;  ///< the response at the velocity it was asked for last
};

/** A lane's joint from a term; null: none, which never acts. Terms whose softness or proximal point changed must be set again. */
void setLane(const JointTerm* term, int lane, JointBlock* block);
/** JointTerm::expect at a lane's present velocity; null: no joint. */
void expect(const JointTerm* term, int lane, JointBlock* block);
/** Impulses and stiffnesses at velocity + a step. first, second: their slope along the step and its derivative are added */
void respond(double a, JointBlock* begin, JointBlock* end, double* first, double* second);
/** JointTerm::creep, the worst. */
double creep(const JointBlock* begin, const JointBlock* end);

}  // namespace blem_sim::dynamics
