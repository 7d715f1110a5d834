// A solve, and what it was made of.
#pragma once

#include <vector>

#include "blem_sim/dynamics/world_types.h"
#include "contacts/constraints/constraint_maker.h"
#include "contacts/search/found_contacts.h"

namespace blem_sim::sim {

/** A solve that was made: the step guard accepts it, or has it made again. Valid until the next one begins. */
struct MadeSolve {
  const FoundContacts& start;      ///< contacts of the state where it started
  const SolverContacts& contacts;  ///< that it was made with
  const std::vector<dynamics::JointDrive>& drives;
  const dynamics::SolveResult& result;
  const std::vector<dynamics::BodyState>&before, &after;  ///< bodies at its start and end, by slot
  double dt;                                              ///< [s] its length
};

}  // namespace blem_sim::sim
