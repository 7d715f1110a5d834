// Velocities of a fast tree's joints in the middle of its free way, which motors and viscous friction answer to.
#pragma once

#include "problem/make_terms.h"
#include "problem/solver_space.h"

namespace blem_sim::dynamics {

/** Whether a joint of a fast tree answers so stiffly that it keeps its velocity on the free way. @param inertia of its dof alone */
bool keepsVelocity(const JointTerm& joint, double velocity, double inertia);

/**
 * Sets the leads of fast trees' joints: what half of the free way will add to the velocities that the solve finds. Without them an arm that
 * keeps its pose while it whirls round would set out at half a step of its free acceleration, and be damped at that speed.
 * Joints that keep their velocity on the way, and those of mimic relations, have none. Before the solve; drift and node_twist are lost.
 * @param trees of the island @param joints their terms, tree by tree
 */
void setLeads(const TermSource& source, const std::vector<int>& trees, std::vector<JointTerm>* joints, ForestMotion* motion,
              SolverSpace* space);

}  // namespace blem_sim::dynamics
