// From contacts, drives and loops of the scene to the terms of an island's model.
#pragma once

#include <vector>

#include "problem/island_model.h"
#include "scene/step_memory.h"
#include "scene/stepper.h"
#include "trees/forest_motion.h"
#include "trees/team.h"

namespace blem_sim::dynamics {

/** Input of all terms in one step. */
struct TermSource {
  const Scene& scene;
  const Forest& forest;
  const ForestMotion& motion;
  const StepInput& input;
  const SolverSettings& settings;
  const StepMemory& memory;
};

/** Motor, friction and limits of a node's joint. Precondition: the node has one dof. */
JointTerm jointTerm(const TermSource& source, int node);

/** Adds the terms of the drive of a free root, if the step has one. @param node that root */
void addRootTerms(const TermSource& source, int node, std::vector<JointTerm>* terms);

/** @param index of the loop in the forest; pair: child and parent */
LoopTerm loopTerm(const TermSource& source, int index, BodyPair* pair);

/**
 * Patches of the model and terms of usable contacts, each with its proximal weight.
 * @param contacts of the input, those of a pair one after the other; team: its threads share the patches
 */
void makeContactTerms(const TermSource& source, const std::vector<int>& contacts, Team* team, IslandModel* model, IslandTerms* terms);

/** +1 if the contact's A is the body the term's impulse acts on, -1 if it is B, A being the static world. */
inline double termSign(const ContactConstraint& contact) { return contact.body_a == WORLD_BODY ? -1 : 1; }

}  // namespace blem_sim::dynamics
