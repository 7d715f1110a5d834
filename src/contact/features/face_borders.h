// Edges and faces around a point on the border of a face's plane.
#pragma once

#include <algorithm>

#include "features/face_shape.h"

namespace blem_sim::contact {
namespace face_borders_detail {

inline int cornerAt(const FaceShape& face, const Vector3& p) {
  for (int k = 0; k < 3; ++k) {
    if ((p - face.corners[k]).squaredNorm() <= 16 * CLOSED * CLOSED) return k;
  }
  return -1;
}

/** Whether p is within CLOSED of the edge. */
inline bool liesOn(const MeshPair& pair, Side edge_side, int edge, const Vector3& p) {
  const MeshSide& side = pair.side(edge_side);
  const std::array<int, 2> ends = side.topology.ends(side.mesh, edge);
  const Vector3 q = pair.placed(side.mesh.vertices[ends[0]], edge_side), along = pair.placed(side.mesh.vertices[ends[1]], edge_side) - q;
  const double length2 = along.squaredNorm(), part = std::min(std::max((p - q).dot(along), 0.0), length2);
  return (p - q - part / length2 * along).squaredNorm() <= CLOSED * CLOSED;
}

template <typename Visit>
void visitIfBorder(const geometry::MeshTopology& topology, int edge, int patch, Visit&& visit) {
  if (topology.isFlatEdge(edge)) return;
  for (const int face : topology.facesOf(edge)) {
    if (topology.patchOf(face) == patch) return visit(edge, face);
  }
}

}  // namespace face_borders_detail

/** Calls visit(edge, face) for each edge where the plane of `face` ends within CLOSED of p (frame F), with the plane's face there. */
template <typename Visit>
void forEachBorderAt(const MeshPair& pair, const FaceShape& face, Side face_side, const Vector3& p, Visit&& visit) {
  using namespace face_borders_detail;
  const MeshSide& side = pair.side(face_side);
  const geometry::MeshTopology& topology = side.topology;
  const auto forEachEdgeAt = [&](int k, auto&& visit_edge) {
    const int vertex = side.mesh.elements[face.element][k];
    for (const int edge : topology.edgesOf(vertex)) visit_edge(edge);
  };
  const int corner = cornerAt(face, p);
  if (corner >= 0) {
    // The plane's borders there may belong to its other faces.
    forEachEdgeAt(corner, [&](int edge) { visitIfBorder(topology, edge, topology.patchOf(face.element), visit); });
    return;
  }
  // A border that p lies on need not be a side of this face where two sides meet at a small angle, but it ends at one of its corners.
  for (int k = 0; k < 3; ++k) {
    forEachEdgeAt(k, [&](int edge) {
      if (liesOn(pair, face_side, edge, p)) visitIfBorder(topology, edge, topology.patchOf(face.element), visit);
    });
  }
}

/**
 * Calls visit(direction into it, unit normal) for each face of other planes where the plane of `face` ends within CLOSED of p (frame F).
 * @return whether it does
 */
template <typename Visit>
bool forEachNeighbourAt(const MeshPair& pair, const FaceShape& face, Side face_side, const Vector3& p, Visit&& visit) {
  const MeshSide& side = pair.side(face_side);
  const geometry::MeshTopology& topology = side.topology;
  const auto visitFacesOf = [&](int edge) {
    for (const int neighbour : topology.facesOf(edge)) {
      if (topology.patchOf(neighbour) == topology.patchOf(face.element)) continue;
      const Vector3i& v = side.mesh.elements[neighbour];
      const Vector3 middle = (side.mesh.vertices[v[0]] + side.mesh.vertices[v[1]] + side.mesh.vertices[v[2]]) / 3;
      visit(pair.placed(middle, face_side) - p, pair.turned(geometry::MeshTopology::normal(side.mesh, neighbour), face_side));
    }
  };
  const int corner = face_borders_detail::cornerAt(face, p);
  if (corner >= 0) {
    const int vertex = side.mesh.elements[face.element][corner];
    for (const int edge : topology.edgesOf(vertex)) visitFacesOf(edge);
    return !topology.isFlatVertex(vertex);
  }
  bool at_border = false;
  forEachBorderAt(pair, face, face_side, p, [&](int edge, int) {
    at_border = true;
    visitFacesOf(edge);
  });
  return at_border;
}

}  // namespace blem_sim::contact
