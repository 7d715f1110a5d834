// Answers of an island's trees to impulses at once: by their mass, joints that mimic others following them.
#pragma once

#include <vector>

#include "problem/island_model.h"
#include "trees/forest_motion.h"
#include "trees/islands.h"
#include "trees/response_unit.h"
#include "trees/tree_rows.h"

namespace blem_sim::dynamics {

/** Vectors over the forest that impacts are reckoned in, each island in its own trees. */
struct ImpactSpace {
  Eigen::VectorXd velocity;  ///< with half of the step's forces: that of the moment when impacts happen
  Eigen::VectorXd leap;      ///< its change by impacts
  Eigen::VectorXd momentum;  ///< the sum of impulses
  Eigen::VectorXd before;    ///< velocity at the beginning of a round
  Eigen::VectorXd column;    ///< work space
  Eigen::VectorXd no_gains;  ///< zero: motors give no impulses
  TreeFactor factor;         ///< of the mass matrix of trees without mimic joints
  TreePaths paths;
  std::vector<Vector6> twist;  ///< per node

  void resize(const Forest& forest);
};

/**
 * Inverse mass of an island's trees. Trees that mimic joints tie answer together; each other tree answers alone. Used again from step to
 * step, so that it need not allocate.
 */
class ImpactMass {
 public:
  /** Factors the mass matrices of the model's trees. Precondition: the model outlives the use. */
  void factor(const Forest& forest, const ForestMotion& motion, const IslandModel& model, ImpactSpace* space);
  /** The trees that an impulse on a tree moves, ascending. */
  const std::vector<int>& movedWith(int tree) const { return units_[unitOf(tree)].trees; }
  /** From impulses to changes of velocity, in place, on the dofs of all trees that move with one. */
  void solve(const Forest& forest, int tree, Eigen::VectorXd* x, ImpactSpace* space);
  /** Number of a tree's unit, below that of the trees. */
  int unitOf(int tree) const;

 private:
  struct Unit {
    std::vector<int> trees;
    bool folded = false;  ///< joints of these trees mimic each other
    ResponseUnit response;
  };

  const IslandModel* model_ = nullptr;
  Islands ties_;  ///< of the model's trees
  std::vector<Unit> units_;
  std::vector<double> values_;
};

}  // namespace blem_sim::dynamics
