#include "neighbourhood/vertex_cone.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "features/feature_cones.h"

namespace blem_sim::contact {
namespace {

/** Sum of the normals of the faces around; any direction if there is none. */
Vector3 axisOf(const MeshSide& side, int vertex) {
  Vector3 sum = Vector3::Zero();
  for (const int edge : side.topology.edgesOf(vertex)) {
    const int other = side.topology.otherEnd(side.mesh, edge, vertex);
    for (const int face : side.topology.facesOf(edge)) {
      // Each face once, at that edge of both that leaves the vertex by the face's winding.
      const Vector3i& e = side.mesh.elements[face];
      const int k = e[0] == vertex ? 1 : e[1] == vertex ? 2 : 0;
      if (e[k] == other) sum += geometry::MeshTopology::normal(side.mesh, face);
    }
  }
  const double norm = sum.norm();
  return norm > 0 ? Vector3(sum / norm) : Vector3::UnitZ();
}

}  // namespace

kernels::VertexCone vertexCone(const MeshSide& side, int vertex, SurroundingsMemory* surroundings, std::vector<double>* room) {
  constexpr double ANY = 1e6, ROUNDING = 0.002, LEAST_COSINE = 0.15;  // cosine: of half the widest gap between edges, seen along the axis
  const Vector3 axis = axisOf(side, vertex), x = axis.unitOrthogonal(), y = axis.cross(x);
  double up = -ANY, down = -ANY, least_across = 1;
  bool is_round = true;
  std::vector<double>& angles = *room;
  angles.clear();
  for (const int edge : side.topology.edgesOf(vertex)) {
    const Vector3 w = (side.mesh.vertices[side.topology.otherEnd(side.mesh, edge, vertex)] - side.mesh.vertices[vertex]).normalized();
    const double along = w.dot(axis), across = std::sqrt(std::max(1 - along * along, 1e-12));
    up = std::max(up, -along / across);
    down = std::max(down, along / across);
    least_across = std::min(least_across, across);
    angles.push_back(std::atan2(w.dot(y), w.dot(x)));
    is_round = is_round && (side.topology.isFlatEdge(edge) || surroundings->ofEdge(side, edge).is_round);
  }
  std::sort(angles.begin(), angles.end());
  double gap = angles.empty() ? 2 * M_PI : angles.front() + 2 * M_PI - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  const double cosine = std::cos(std::min(0.5 * gap, M_PI));
  const auto number = [](double value) { return static_cast<float>(value); };
  kernels::VertexCone cone{{number(axis.x()), number(axis.y()), number(axis.z())}, 0, 0, 0, is_round};
  if (cosine < LEAST_COSINE) {
    cone.up = cone.down = cone.per_slack = number(ANY);
    return cone;
  }
  // A direction's part square to the axis has an edge no farther from it than half a gap: towards that one it must not lead.
  const auto bound = [&](double slope) { return number((slope > 0 ? slope / cosine : slope) + ROUNDING); };
  cone.up = bound(up);
  cone.down = bound(down);
  cone.per_slack = number((1 + ROUNDING) / (least_across * cosine));
  return cone;
}

}  // namespace blem_sim::contact
