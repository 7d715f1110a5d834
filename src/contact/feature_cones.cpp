#include "feature_cones.h"

#include <algorithm>

namespace blem_sim {
namespace {

template <typename Visit>
void forEachEdgeDirection(const MeshSide& side, int vertex, Visit&& visit) {
  const MeshTopology& topology = side.topology;
  for (int i = topology.vertex_edge_begin[vertex]; i < topology.vertex_edge_begin[vertex + 1]; ++i) {
    const std::array<int, 2>& edge = topology.edges[topology.vertex_edges[i]];
    const int other = edge[0] == vertex ? edge[1] : edge[0];
    visit(Vector3(side.mesh.vertices[other] - side.mesh.vertices[vertex]));
  }
}

template <typename Visit>
void forEachFaceDirection(const MeshSide& side, int edge, Visit&& visit) {
  const MeshTopology& topology = side.topology;
  for (int i = topology.edge_face_begin[edge]; i < topology.edge_face_begin[edge + 1]; ++i) {
    visit(topology.inward(side.mesh, edge, topology.edge_faces[i]));
  }
}

}  // namespace

bool vertexConeAllows(const MeshSide& side, int vertex, const Vector3& direction, double slack) {
  bool allows = true;
  forEachEdgeDirection(side, vertex, [&](const Vector3& w) {
    const double along = w.dot(direction);
    allows = allows && !(along > 0 && along * along > slack * slack * w.squaredNorm());
  });
  return allows;
}

bool edgeConeAllows(const MeshSide& side, int edge, const Vector3& direction, double slack) {
  bool allows = true;
  forEachFaceDirection(side, edge, [&](const Vector3& u) { allows = allows && u.dot(direction) <= slack; });
  return allows;
}

double vertexSlope(const MeshSide& side, int vertex, const Vector3& direction) {
  double slope = -1;
  forEachEdgeDirection(side, vertex, [&](const Vector3& w) { slope = std::max(slope, w.dot(direction) / w.norm()); });
  return slope;
}

double edgeSlope(const MeshSide& side, int edge, const Vector3& direction) {
  double slope = -1;
  forEachFaceDirection(side, edge, [&](const Vector3& u) { slope = std::max(slope, u.dot(direction)); });
  return slope;
}

Vector3 vertexLean(const MeshSide& side, int vertex) {
  Vector3 lean = Vector3::Zero();
  forEachEdgeDirection(side, vertex, [&lean](const Vector3& w) { lean += w.normalized(); });
  return lean;
}

Vector3 edgeLean(const MeshSide& side, int edge) {
  Vector3 lean = Vector3::Zero();
  forEachFaceDirection(side, edge, [&lean](const Vector3& u) { lean += u; });
  return lean;
}

Vector3 bodySide(const MeshPair& pair, const Vector3& point) {
  const Vector3 from_moving = pair.X_FM * pair.moving.bounds.center() - point, from_fixed = pair.fixed.bounds.center() - point;
  const double moving_size = pair.moving.bounds.diagonal().squaredNorm(), fixed_size = pair.fixed.bounds.diagonal().squaredNorm();
  if (moving_size < fixed_size) return from_moving;
  if (moving_size > fixed_size) return -from_fixed;
  return from_moving - from_fixed;
}

}  // namespace blem_sim
