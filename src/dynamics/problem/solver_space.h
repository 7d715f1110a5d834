// Work space of the islands' solves.
#pragma once

#include <vector>

#include "lanes/spatial.h"
#include "trees/tree_rows.h"

namespace blem_sim::dynamics {

/** Vectors over the forest that the islands work in, each in its own trees. */
struct SolverSpace {
  Eigen::VectorXd free_momentum;  ///< M v*
  Eigen::VectorXd velocity, mass_velocity, gradient, direction, mass_direction, scale;
  /// M (v - v*). While a problem is iterated: on live dofs, with the share of idle ones that follow them; else on all dofs.
  Eigen::VectorXd kinetic;
  Eigen::VectorXd first_velocity, first_kinetic;  ///< at the first iterate
  Eigen::VectorXd anchor;                         ///< the velocities from which idle dofs follow
  Eigen::VectorXd idle_pull;                      ///< the right-hand side there, reduced: by it idle dofs move if live ones do not
  TreeFactor idle;                                ///< of idle dofs; the rows of live ones hold the rest of M, the base of their Hessian
  TreeFactor hessian;                             ///< of live dofs, in the end; before a solve, work space
  TreePaths paths;
  std::vector<Vector6> twist, wrench;  ///< per node
  std::vector<Matrix6> stiffness;      ///< per node
  std::vector<char> stiff;             ///< per node: stiffness is not zero
  std::vector<char> live;              ///< per node: contacts, loops or mimic joints act on it or on a node that it carries

  void resize(const Forest& forest);
};

}  // namespace blem_sim::dynamics
