// Reference for the times of contact generation: a plain binary tree of boxes in double, one triangle pair at a time.
#pragma once

#include <utility>
#include <vector>

#include "blem_sim/geometry/closest_points.h"
#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim {

/** Binary tree of axis-aligned boxes over the triangles of a mesh: halves at the median of the longest axis, one triangle a leaf. */
class PlainTree {
 public:
  explicit PlainTree(const geometry::TriangleMesh& mesh);

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
    int right = 0;     ///< the left child is the next node; 0: a leaf
    int triangle = 0;  ///< of a leaf: place in triangles_ and order_
    double size() const { return box.sizes().sum(); }
  };
  void build(int first, int count, const geometry::TriangleMesh& mesh, const std::vector<Box>& boxes);

  std::vector<int> order_;                     ///< element of the mesh by place
  std::vector<geometry::Triangle> triangles_;  ///< corners by place
  std::vector<Node> nodes_;
};

}  // namespace blem_sim
