// Response of trees whose velocities answer together: (M + D)^-1, D being the gains of motors and viscous friction.
#pragma once

#include <vector>

#include "lanes/body_pair.h"
#include "trees/forest_motion.h"

namespace blem_sim::dynamics {

/** Trees whose velocities answer together: one tree, or several that mimic joints tie. Free bodies are no units. */
class ResponseUnit {
 public:
  std::vector<int> dofs;  ///< ascending

  /** Factors M + D. @param gains D by dof of the forest; mimics: of the island. @return false if it is not positive definite */
  bool factor(const Forest& forest, const ForestMotion& motion, const Eigen::VectorXd& gains, const std::vector<MimicFold>& mimics);
  /** Solves in place for `columns` right-hand sides, one value per entry of `dofs` each. */
  void solve(double* values, int columns) const;
  int size() const { return static_cast<int>(dofs.size()); }
  /** Index of a dof among `dofs`. Precondition: it is one of them. */
  int rowOf(int dof) const;

 private:
  struct Fold {
    int row, master;
    double multiplier;
  };
  std::vector<double> matrix_;
  std::vector<Fold> folds_;
};

}  // namespace blem_sim::dynamics
