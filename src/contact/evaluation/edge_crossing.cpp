#include "evaluation/edge_crossing.h"

#include <cmath>

#include "features/face_borders.h"
#include "features/feature_cones.h"

namespace blem_sim::contact {
namespace {

/** A surface along a plane leaves it if its lean has this part (sine) off it. */
constexpr double MIN_LEAN_INSIDE = 1e-3;

}  // namespace

bool crosses(const MeshPair& pair, const Crossing& crossing) {
  const Side side = crossing.edge_side;
  const MeshSide& edge_mesh = pair.side(side);
  const FaceShape face = faceShape(pair, !side, crossing.face);
  const std::array<int, 2> ends = edge_mesh.topology.ends(edge_mesh.mesh, crossing.edge);
  const Vector3 p = pair.placed(edge_mesh.mesh.vertices[ends[0]], side), q = pair.placed(edge_mesh.mesh.vertices[ends[1]], side);
  const double height_p = face.normal.dot(p - face.corners[0]), height_q = face.normal.dot(q - face.corners[0]);
  const Vector3 through = p + height_p / (height_p - height_q) * (q - p);
  if (!holdsProjection(face, through)) return false;
  const Vector3 lean = pair.turned(edgeLean(edge_mesh, crossing.edge), side), face_inward = middle(face.corners) - through;
  // At a border the edge only grazes an edge or a corner, unless it runs down along a neighbour's plane, its own surface within: so aligned
  // boxes sink into each other.
  bool enters = true, along_neighbour = false;
  const bool at_border = forEachNeighbourAt(pair, face, !side, through, [&](const Vector3& inward, const Vector3& normal) {
    const Vector3& end = (face.normal.dot(inward) > 0) == (height_p > 0) ? p : q;
    double inside = normal.dot(end - through);
    if (std::abs(inside) <= TOUCH) {
      along_neighbour = true;
      inside = std::abs(normal.dot(lean)) > MIN_LEAN_INSIDE ? normal.dot(lean) : 0;
    }
    enters = enters && (normal.dot(face_inward) < 0 ? -inside : inside) > TOUCH;
  });
  return !at_border || (enters && along_neighbour);
}

}  // namespace blem_sim::contact
