// What contact generation is measured against: a plain binary tree of boxes in double, one triangle pair at a time.
#pragma once

#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim {

/** Binary tree of axis-aligned boxes over the triangles of a mesh: halves at the median of the longest axis, leaves of four. */
class PlainTree {
 public:
  explicit PlainTree(const TriangleMesh& mesh);

  /**
   * Lists the pairs of triangles within `range` [m] of each other, exact distances in double.
   * @param X_BA pose of mesh A's frame in mesh B's frame
   * @param pairs overwritten: (triangle of A, triangle of B)
   */
  static void trianglePairs(const PlainTree& a, const PlainTree& b, const Pose& X_BA, double range,
                            std::vector<std::pair<int, int>>* pairs);

 private:
  struct Node {
    Box box;
    int first = 0, count = 0;  ///< of a leaf, in order_
    int left = -1, right = -1;
  };
  int build(int first, int count, std::vector<Vector3>* middles);

  const TriangleMesh& mesh_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace blem_sim
