// Live parts of an island: nodes that something acts on, and those that carry them. The others are idle: they need not be iterated.
#pragma once

#include <vector>

#include "problem/island_at_hand.h"

namespace blem_sim::dynamics {

class LiveParts {
 public:
  /** Marks nodes that contacts, loops or mimic joints act on, and those that carry them; list() lists them. */
  void find(const IslandAtHand& island);
  /** Marks the node that a dof moves, too. */
  void wake(int dof) { mark(island_->forest.nodeOfDof(dof)); }
  void wakeAll();
  /** Lists the parts as they are marked. */
  void list();

  bool isIdle(int dof) const { return !island_->space->live[island_->forest.nodeOfDof(dof)]; }
  const std::vector<int>& nodes() const { return nodes_; }         ///< live, ascending
  const std::vector<int>& dofs() const { return dofs_; }           ///< live, ascending
  const std::vector<int>& idleDofs() const { return idle_dofs_; }  ///< ascending

  /** Visits live dofs, then idle ones. */
  template <typename Visit>
  void forDofs(const Visit& visit) const {
    for (const std::vector<int>* dofs : {&dofs_, &idle_dofs_})
      for (const int k : *dofs) visit(k);
  }

 private:
  void mark(int node);

  const IslandAtHand* island_ = nullptr;
  std::vector<int> nodes_, dofs_, idle_dofs_;
};

}  // namespace blem_sim::dynamics
