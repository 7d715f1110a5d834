#include "features/feature_cones.h"

#include <algorithm>
#include <cmath>

#include "features/edge_pair.h"

namespace blem_sim::contact {
namespace {

/** Direction from the vertex, one of the edge's ends, along the edge; not unit, mesh's frame. */
Vector3 edgeDirection(const MeshSide& side, int vertex, int edge) {
  return side.mesh.vertices[side.topology.otherEnd(side.mesh, edge, vertex)] - side.mesh.vertices[vertex];
}

template <typename Visit>
void forEachFaceDirection(const MeshSide& side, int edge, Visit&& visit) {
  for (const int face : side.topology.facesOf(edge)) visit(side.topology.inward(side.mesh, edge, face));
}

/** A direction summed from neighbours means nothing below this. */
constexpr double MIN_LEAN = 1e-6;

Vector3 leanOf(const MeshSide& side, const Feature& feature) {
  if (feature.kind == FeatureKind::VERTEX) return vertexLean(side, feature.index);
  if (feature.kind == FeatureKind::EDGE) return edgeLean(side, feature.index);
  return Vector3::Zero();
}

/** Direction from the fixed surface to the moving one at features that touch; not unit, frame F. */
Vector3 leanBetween(const MeshPair& pair, const Feature& m, const Feature& f) {
  return pair.X_FM.linear() * leanOf(pair.moving, m) - leanOf(pair.fixed, f);
}

}  // namespace

bool edgeConeAllows(const MeshSide& side, int edge, const Vector3& direction, double slack) {
  bool allows = true;
  forEachFaceDirection(side, edge, [&](const Vector3& u) { allows = allows && u.dot(direction) <= slack; });
  return allows;
}

bool isRoundEdge(const MeshSide& side, int edge) {
  const geometry::EdgeFaces faces = side.topology.facesOf(edge);
  if (side.topology.isFlatEdge(edge) || faces.size() != 2) return false;
  return isRound(side.topology.inward(side.mesh, edge, faces[0]), side.topology.inward(side.mesh, edge, faces[1]));
}

Vector3 vertexLean(const MeshSide& side, int vertex) {
  Vector3 lean = Vector3::Zero();
  for (const int edge : side.topology.edgesOf(vertex)) lean += edgeDirection(side, vertex, edge).normalized();
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

Vector3 towardsMoving(const MeshPair& pair, const Vector3& axis, const Feature& m, const Feature& f, const Vector3& point) {
  double along = leanBetween(pair, m, f).dot(axis);
  if (std::abs(along) <= MIN_LEAN) along = bodySide(pair, point).dot(axis);
  return along < 0 ? Vector3(-axis) : axis;
}

Vector3 touchNormal(const MeshPair& pair, const Feature& m, const Feature& f, const Vector3& point, const Vector3& along) {
  const double length2 = along.squaredNorm();
  for (const Vector3& direction : {leanBetween(pair, m, f), bodySide(pair, point)}) {
    const Vector3 square = length2 > 0 ? Vector3(direction - direction.dot(along) / length2 * along) : direction;
    const double norm = square.norm();
    if (norm > MIN_LEAN * (1 + direction.norm())) return square / norm;
  }
  return length2 > 0 ? along.unitOrthogonal() : Vector3(Vector3::UnitZ());
}

}  // namespace blem_sim::contact
