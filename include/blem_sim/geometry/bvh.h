// Bounding volume hierarchy over the elements of a TriangleMesh.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

/**
 * Binary tree of axis-aligned float boxes in the mesh's frame, rounded outwards, so that a box always holds all of its elements.
 * Built by binned surface area heuristic, by the threads there are, whose number does not show; deterministic. Nodes lie in one array,
 * children adjacent; leaves hold a run of order(). Precondition: finite vertices, indices in range, as cleanMesh leaves them. [Wald 2007]
 */
class Bvh {
 public:
  struct Node {
    Node() {}                      ///< not set: there are millions
    Eigen::Vector3f lower, upper;  ///< [m] mesh frame
    std::uint32_t first;           ///< leaf: first index into order(); inner: index of the left child, the right one follows it
    std::uint32_t count;           ///< elements of a leaf; 0 for an inner node
    bool isLeaf() const { return count != 0; }
  };

  static constexpr int MAX_DEPTH = 64;  ///< edges from the root to the deepest leaf, at most: a walk needs no more stack

  Bvh() = default;
  explicit Bvh(const TriangleMesh& mesh, int leaf_size = 4);

  bool empty() const { return nodes_.empty(); }
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<std::uint32_t>& order() const { return order_; }  ///< element indices, grouped by leaf
  std::size_t bytes() const { return nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof(std::uint32_t); }  ///< memory held

 private:
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

/**
 * Calls visit(leaf_a, leaf_b) with the node indices of every pair of leaves whose boxes may be within `margin` [m]; conservative, each
 * pair once, order determined by the trees alone. @param X_BA pose of mesh A's frame in mesh B's frame.
 * Implemented as a template in bvh_traversal.h.
 */
template <typename Visit>
void visitLeafPairs(const Bvh& a, const Bvh& b, const Pose& X_BA, double margin, Visit&& visit);

/** Two trees. */
struct BvhPair {
  const Bvh& a;
  const Bvh& b;
  const Pose& X_BA;  ///< pose of A's frame in B's
};

/** The same below pairs of nodes for which matters(node_a, node_b) holds. */
template <typename Matters, typename Visit>
void visitLeafPairsIf(const BvhPair& trees, double margin, Matters&& matters, Visit&& visit);

/** Calls visit(leaf) for every leaf whose box meets `box` (tree's frame). In bvh_traversal.h. */
template <typename Visit>
void visitLeaves(const Bvh& tree, const Box& box, Visit&& visit);

/** Calls visit(leaf) for every leaf with a corner at signed distance n.x - d <= margin of the plane (tree's frame). In bvh_traversal.h. */
template <typename Visit>
void visitLeavesBelowPlane(const Bvh& tree, const Vector3& n, double d, double margin, Visit&& visit);

/** Exact smallest distance [m] from a point to the mesh, by the tree. Infinity for an empty mesh. */
double distanceToMesh(const Bvh& tree, const TriangleMesh& mesh, const Vector3& p);

}  // namespace blem_sim::geometry
