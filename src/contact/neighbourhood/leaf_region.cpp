#include "neighbourhood/leaf_region.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "features/tolerances.h"
#include "kernels/vectors.h"

namespace blem_sim::contact {
namespace {

/** Directions farther than this [rad] from the axis: points may lie anywhere within range. */
constexpr double WIDE = 0.7;
/** Rounding and slack of cones [rad], but for the slack of edges with edges. */
constexpr double ANGLE_SLACK = 1e-3;
constexpr double EDGE_SLACK = 1.01 * EDGE_CONE_SLACK + ANGLE_SLACK;

/** Direction around which the faces sum up, whichever way they are wound. */
Vector3 leafAxis(const LeafFeatures& leaf) {
  Vector3 axis = Vector3::Zero();
  for (const kernels::FaceRecord& face : leaf.faces.records) {
    const Vector3 normal = vector3(face.plane);
    axis += axis.dot(normal) < 0 ? Vector3(-normal) : normal;
  }
  const double norm = axis.norm();
  return norm > 0 ? Vector3(axis / norm) : Vector3::UnitZ();
}

/** Gathers the directions of contacts that the features of a leaf allow. */
class Directions {
 public:
  explicit Directions(const Vector3& axis) : axis_(axis) {}

  void addFace(const kernels::FaceRecord& face, kernels::OpenSides open) {
    add(vector3(face.plane), 0);
    fades_ = fades_ || open != 0;
  }

  void addEdge(const kernels::EdgeRecord& edge) {
    const Vector3 u = vector3(edge.inward[0]), v = vector3(edge.inward[1]), out = vector3(edge.along).cross(u - v).normalized();
    // With fewer than two faces: all directions that lead away from them.
    const double half = (u - v).norm() > 1.01 ? std::acos(std::min(0.5 * (u - v).norm(), 1.0)) : M_PI;
    add(out, half);
    edges_ = std::max(edges_, angleFrom(out) + half);
    fades_ = fades_ || edge.along.w < 0;
  }

  void addVertex(const kernels::LeafCones& cones, std::size_t i) {
    const double widest = std::max(cones.up[i], cones.down[i]);
    if (widest >= 0) add(Vector3(cones.axes[0][i], cones.axes[1][i], cones.axes[2][i]), std::atan(widest));
  }

  /** Elements without area are seen from everywhere. */
  void addAll() { angle_ = edges_ = M_PI; }

  void write(kernels::LeafRegion* region) const {
    const double angle = angle_ + ANGLE_SLACK, of_edges = edges_ + EDGE_SLACK;
    const bool anywhere = angle > WIDE;
    region->lean = anywhere ? 1 : static_cast<float>(std::sin(angle));
    // No contact is longer than the range; one that fades is the shorter the farther beside.
    region->fall = anywhere || fades_ ? 1 / FADE_SLOPE : 0;
    region->edge_beside = of_edges > WIDE ? 2 : static_cast<float>(1 + std::sin(of_edges));
  }

 private:
  /** Angle [rad] from the axis or its opposite. */
  double angleFrom(const Vector3& direction) const { return std::acos(std::min(std::abs(axis_.dot(direction)), 1.0)); }

  /** Adds directions within an angle [rad] around one. */
  void add(const Vector3& direction, double half) { angle_ = std::max(angle_, angleFrom(direction) + half); }

  const Vector3 axis_;
  double angle_ = 0, edges_ = 0;
  bool fades_ = false;
};

void placeBox(const MeshSide& side, const geometry::Bvh::Node& node, const Vector3 (&axes)[3], kernels::LeafRegion* region) {
  for (int k = 0; k < 3; ++k) {
    double lower = std::numeric_limits<double>::infinity(), upper = -lower;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Vector3i& face = side.mesh.elements[side.bvh.order()[i]];
      for (int corner = 0; corner < 3; ++corner) {
        const double at = axes[k].dot(side.mesh.vertices[face[corner]]);
        lower = std::min(lower, at);
        upper = std::max(upper, at);
      }
    }
    Eigen::Map<Eigen::Vector3f>(region->axes[k]) = axes[k].cast<float>();
    region->middle[k] = static_cast<float>(0.5 * (lower + upper));
    region->halves[k] = static_cast<float>(0.5 * (upper - lower));
  }
}

}  // namespace

kernels::LeafRegion leafRegion(const MeshSide& side, const geometry::Bvh::Node& node, const LeafFeatures& leaf) {
  const Vector3 up = leafAxis(leaf), x = up.unitOrthogonal(), axes[3] = {x, up.cross(x), up};
  kernels::LeafRegion region;
  Directions directions(up);
  for (std::size_t i = 0; i < leaf.faces.records.size(); ++i) directions.addFace(leaf.faces.records[i], leaf.shapes.faces.open[i]);
  for (const kernels::EdgeRecord& edge : leaf.edges.records) directions.addEdge(edge);
  for (std::size_t i = 0; i < leaf.vertices.records.size(); ++i)
    directions.addVertex(leaf.shapes.cones[i / kernels::LEAF_BLOCK], i % kernels::LEAF_BLOCK);
  if (leaf.faces.records.size() < node.count) directions.addAll();
  directions.write(&region);
  placeBox(side, node, axes, &region);
  return region;
}

}  // namespace blem_sim::contact
