// Who owns what: vertices, edges and faces of a soup, each once, with what a closest-point test needs to know of their neighbours.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim {

/**
 * Features of a TriangleMesh: its vertices, its edges (each once, with any number of incident faces: none for a segment, one on a border,
 * two inside a surface, more where a soup is not a manifold) and its faces (elements with area). Nothing is assumed of winding.
 * A feature is flat, and owns nothing, where it lies inside a plane: an edge whose faces continue each other, a vertex with flat edges
 * only. Nor does a vertex inside a straight edge, whose parts speak for it. Made by the threads there are, whose number does not show.
 * Precondition: indices in range; coincident vertices are one, as
 * cleanMesh leaves them (else neighbours are not seen: more features, none lost).
 */
struct MeshTopology {
  MeshTopology() = default;
  explicit MeshTopology(const TriangleMesh& mesh);

  /** Opposite in-plane directions within this sine are one plane: rounding, not noise. */
  static constexpr double FLAT_SINE = 1e-6;
  static constexpr int NO_EDGE = -1;

  std::vector<std::array<int, 2>> edges;          ///< vertices, lower index first; sorted
  std::vector<int> edge_face_begin;               ///< size edges + 1: faces of edge i are edge_faces[edge_face_begin[i] .. [i + 1])
  std::vector<int> edge_faces;                    ///< elements, ascending per edge
  std::vector<int> vertex_edge_begin;             ///< size vertices + 1, as above
  std::vector<int> vertex_edges;                  ///< edges, ascending per vertex
  std::vector<std::array<int, 3>> element_edges;  ///< edge between corners k and k + 1, NO_EDGE if they coincide
  std::vector<Vector3> normals;                   ///< unit, by the element's winding; zero for elements without area: they are no faces
  std::vector<std::uint8_t> edge_flat;
  std::vector<std::uint8_t> vertex_flat;
  std::vector<std::uint8_t> vertex_straight;  ///< but for flat ones it has two edges, which continue each other
  std::vector<int> patch;                     ///< per element: first element of the plane that it is part of, across flat edges

  bool isFace(int element) const { return !normals[element].isZero(0); }
  /** Is this element the one that asks for its corner k / its edge between corners k and k + 1? Never for flat ones. */
  bool ownsVertex(int element, int k) const { return owned_[element] >> k & 1; }
  bool ownsEdge(int element, int k) const { return owned_[element] >> (3 + k) & 1; }

  /** Bits k of the vertices / edges that it asks for. */
  std::uint8_t ownedVertices(int element) const { return owned_[element] & 7; }
  std::uint8_t ownedEdges(int element) const { return owned_[element] >> 3; }

  std::size_t bytes() const;  ///< of memory

  /** Unit direction in the face's plane, square to the edge, into the face. @param face one of the edge's faces */
  Vector3 inward(const TriangleMesh& mesh, int edge, int face) const;

 private:
  void findEdges(const TriangleMesh& mesh);
  void findRings(int vertex_count);
  void findFlatness(const TriangleMesh& mesh);
  void findPatches();
  void findOwners(const TriangleMesh& mesh);
  bool isFlat(const TriangleMesh& mesh, int edge) const;
  bool isStraight(const TriangleMesh& mesh, int vertex) const;

  std::vector<std::uint8_t> owned_;  // bits 0-2 vertices, 3-5 edges
};

}  // namespace blem_sim
