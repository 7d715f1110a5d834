// Trees that contacts tie together.
#pragma once

#include <vector>

namespace blem_sim {

/** Union-find over trees; the smallest member names an island. */
class Islands {
 public:
  explicit Islands(int trees);
  void join(int a, int b);
  int root(int tree) const;
  /** Members of each island, both in ascending order. */
  std::vector<std::vector<int>> members() const;

 private:
  std::vector<int> parent_;
};

}  // namespace blem_sim
