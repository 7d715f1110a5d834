// Joint coordinates of trees that stay when others come or go.
#pragma once

#include <vector>

#include "blem_sim/dynamics/world_types.h"
#include "trees/forest.h"
#include "trees/forest_motion.h"

namespace blem_sim::dynamics {

/** Coordinates are kept bit by bit: read back from bodies they would be rounded, and a visitor would move what it never touched. */
class KeptTrees {
 public:
  void clear() { trees_.clear(); }
  void keep(const Forest& forest, int tree, const ForestMotion& motion);
  /** Gives a tree of another forest its coordinates, if it was kept: the same bodies on the same joints. @return whether it was */
  bool restore(const Forest& forest, int tree, ForestMotion* motion) const;

 private:
  struct Kept {
    std::vector<ForestNode> nodes;
    WorldState state;
  };
  std::vector<Kept> trees_;  // by their first bodies, ascending
};

}  // namespace blem_sim::dynamics
