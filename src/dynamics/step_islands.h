// Islands of a step: what its contacts, mimic joints and loops tie together.
#pragma once

#include <vector>

#include "island/island.h"
#include "trees/islands.h"

namespace blem_sim::dynamics {

/** Islands keep their memory from step to step. */
class StepIslands {
 public:
  /** Fills trees, contacts, mimic joints and loops of each island. @param contacts of the step's input; those that are not usable, or whose
   *  bodies cannot move, are left out */
  void find(const Scene& scene, const Forest& forest, const std::vector<ContactConstraint>& contacts);
  int count() const { return count_; }
  Island& operator[](int island) { return islands_[island]; }
  const Island& operator[](int island) const { return islands_[island]; }

 private:
  void join(const Scene& scene, const Forest& forest, const std::vector<ContactConstraint>& contacts);
  void clear();
  void fill(const Scene& scene, const Forest& forest, const std::vector<ContactConstraint>& contacts);
  Island& ofTree(int tree) { return islands_[joined_.islandOf(tree)]; }

  Islands joined_;
  std::vector<Island> islands_;  // those beyond count_ keep their memory only
  int count_ = 0;
};

}  // namespace blem_sim::dynamics
