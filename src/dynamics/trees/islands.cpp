#include "trees/islands.h"

#include <algorithm>
#include <numeric>

namespace blem_sim::dynamics {

void Islands::reset(int trees) {
  parent_.resize(trees);
  std::iota(parent_.begin(), parent_.end(), 0);
}

// Ways are halved as they are gone, so that long chains of joins stay cheap [van Leeuwen and van der Weide 1977].
int Islands::root(int tree) {
  for (; parent_[tree] != tree; tree = parent_[tree]) parent_[tree] = parent_[parent_[tree]];
  return tree;
}

// The smaller root wins, so that it is numbered before its island's other trees.
void Islands::join(int a, int b) {
  const int ra = root(a), rb = root(b);
  parent_[std::max(ra, rb)] = std::min(ra, rb);
}

int Islands::number() {
  int count = 0;
  island_.resize(parent_.size());
  for (int t = 0; t < static_cast<int>(parent_.size()); ++t) {
    const int r = root(t);
    island_[t] = r == t ? count++ : island_[r];
  }
  return count;
}

}  // namespace blem_sim::dynamics
