// An island in one step.
#pragma once

#include <vector>

#include "island/island_impacts.h"
#include "island/island_solver.h"

namespace blem_sim::dynamics {

/** An island with its contacts, impacts and reports of this step. */
struct Island {
  IslandModel model;
  IslandSolver solver;
  std::vector<int> contacts;          ///< of the step's input
  std::vector<int> mimics, loops;     ///< of the forest's
  std::vector<double> apparent_work;  ///< of the contacts [J]
  IslandImpacts impacts;
  NewtonReport report;
  bool followed = true;  ///< no tree was too fast
};

/** Model and terms of an island, from its trees, contacts, mimic joints and loops. */
void makeTerms(const TermSource& source, Island* island);

}  // namespace blem_sim::dynamics
