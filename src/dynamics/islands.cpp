#include "islands.h"

#include <algorithm>
#include <numeric>

namespace blem_sim {

Islands::Islands(int trees) : parent_(trees) { std::iota(parent_.begin(), parent_.end(), 0); }

int Islands::root(int tree) const {
  while (parent_[tree] != tree) tree = parent_[tree];
  return tree;
}

void Islands::join(int a, int b) {
  const int ra = root(a), rb = root(b);
  parent_[std::max(ra, rb)] = std::min(ra, rb);
}

std::vector<std::vector<int>> Islands::members() const {
  std::vector<std::vector<int>> islands;
  std::vector<int> index(parent_.size(), -1);
  for (int t = 0; t < static_cast<int>(parent_.size()); ++t) {
    const int r = root(t);
    if (index[r] < 0) {
      index[r] = static_cast<int>(islands.size());
      islands.emplace_back();
    }
    islands[index[r]].push_back(t);
  }
  return islands;
}

}  // namespace blem_sim
