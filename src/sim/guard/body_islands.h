// Bodies that joints and contacts tie together.
#pragma once

#include <vector>

namespace blem_sim::sim {

/** Disjoint sets of bodies [Tarjan 1975]; the least index of a set stands for it. Allocates only when there are more bodies than ever. */
class BodyIslands {
 public:
  /** Makes every body an island of its own. */
  void start(int bodies) {
    parent_.resize(bodies);
    for (int b = 0; b < bodies; ++b) parent_[b] = b;
  }
  /** Joins the islands of two bodies. The static world, WORLD_BODY, ties nothing. */
  void tie(int a, int b) {
    if (a < 0 || b < 0) return;
    a = islandOf(a);
    b = islandOf(b);
    if (a < b)
      parent_[b] = a;
    else
      parent_[a] = b;
  }
  /** Least body of a body's island. */
  int islandOf(int body) {
    while (parent_[body] != body) {
      parent_[body] = parent_[parent_[body]];
      body = parent_[body];
    }
    return body;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace blem_sim::sim
