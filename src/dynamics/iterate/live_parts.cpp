#include "iterate/live_parts.h"

#include <algorithm>

namespace blem_sim::dynamics {

void LiveParts::find(const IslandAtHand& island) {
  island_ = &island;
  std::vector<char>& live = island.space->live;
  for (const int tree : island.model.trees)
    std::fill(live.begin() + island.tree(tree).first_node, live.begin() + island.tree(tree).node_end, 0);
  for (const PairContacts& p : island.model.pairs) {
    mark(p.pair.a);
    mark(p.pair.b);
  }
  for (const BodyPair& pair : island.model.loop_pairs) {
    mark(pair.a);
    mark(pair.b);
  }
  for (const MimicFold& m : island.model.mimics) {
    wake(m.dof);
    wake(m.master);
  }
}

void LiveParts::mark(int node) {
  std::vector<char>& live = island_->space->live;
  for (; node >= 0 && !live[node]; node = island_->forest.nodes()[node].parent) live[node] = 1;
}

void LiveParts::wakeAll() {
  for (const int k : idle_dofs_) wake(k);
}

void LiveParts::list() {
  nodes_.clear();
  dofs_.clear();
  idle_dofs_.clear();
  for (const int tree : island_->model.trees) {
    for (int i = island_->tree(tree).first_node; i < island_->tree(tree).node_end; ++i) {
      const ForestNode& node = island_->forest.nodes()[i];
      const bool live = island_->space->live[i];
      if (live) nodes_.push_back(i);
      for (int d = 0; d < node.dofs; ++d) (live ? dofs_ : idle_dofs_).push_back(node.first_dof + d);
    }
  }
}

}  // namespace blem_sim::dynamics
