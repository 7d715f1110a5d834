// Trees that contacts, loops or mimic joints tie together.
#pragma once

#include <vector>

namespace blem_sim::dynamics {

/** Union-find over trees; islands are numbered in the order of their smallest trees. */
class Islands {
 public:
  void reset(int trees);
  void join(int a, int b);
  /** Numbers the islands once all is joined. @return their number */
  int number();
  int islandOf(int tree) const { return island_[tree]; }

 private:
  int root(int tree);

  std::vector<int> parent_, island_;
};

}  // namespace blem_sim::dynamics
