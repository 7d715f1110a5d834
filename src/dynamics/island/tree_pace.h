// Pace of a tree: whether a straight way through a step is good enough for it, or its free motion must be followed.
#pragma once

#include "free_way/free_motion.h"
#include "scene/stepper.h"

namespace blem_sim::dynamics {

/** Whether motors or friction act on any joint of the tree. A motor that may not push is none. */
bool isDriven(const Forest& forest, int tree, const StepInput& input);
/** Whether the tree cannot go its way by itself: loops tie it, or mimic joints to another tree. */
bool isTied(const Forest& forest, int tree);
/** Whether a joint of the tree mimics another. */
bool hasMimics(const Forest& forest, int tree);

/** Pace of a tree at the velocities of `start`, for which `motion` has velocity products. @param mass_velocity M times the velocity */
Pace paceOf(const FreeStart& start, const StepInput& input, const Eigen::VectorXd& mass_velocity);

}  // namespace blem_sim::dynamics
