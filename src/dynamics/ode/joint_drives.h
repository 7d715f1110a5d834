// Motors, joint friction and limits as rows of the solve.
#pragma once

#include <vector>

#include "scene/stepper.h"

namespace blem_sim::dynamics {

/**
 * Sets every joint's rows for a step from its drive:
 * - effort given in advance: applied to both bodies;
 * - implicit PD [N m or N]: k (target - q+) + d (target_v - v+) with q+ = q + dt v+ is the row v+ = (k (target - q) + d target_v) / (dt k +
 * d)
 *   - cfm * effort with cfm = 1 / (dt k + d), bounded by max_effort;
 * - viscous friction: the row v+ = -effort / mu_V;
 * - dry friction: the row v+ = 0, bounded by mu_D [Hauser 2013, 4.1];
 * - limits: one-sided rows; v+ >= -gap/dt before the limit, a bounded return speed behind it.
 * Precondition: one drive per joint slot, and one effort of `coupling` (added to the drive's).
 * @param cfm_scale of the friction rows and limits; above 1 when a step is done again
 */
void setDrives(Scene* scene, const StepInput& input, const std::vector<double>& coupling, const SolverSettings& settings, double cfm_scale);

/**
 * Efforts [N m or N] along the axes, after the step: those given in advance and those of the rows; of the motors alone, and of all.
 * @param axes world axes of the moving joints at the start of the step, by slot
 */
void readEfforts(const Scene& scene, const std::vector<JointDrive>& drives, const std::vector<double>& coupling,
                 const std::vector<Vector3>& axes, SolveResult* result);

}  // namespace blem_sim::dynamics
