// Vertices, edges and faces of a soup, each once, with their owners and the neighbours that a closest-point test needs to know.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

struct SidesByVertex;

/** The faces of an edge, ascending. More than two lie with the topology, which must outlive this. */
class EdgeFaces {
 public:
  EdgeFaces(int first, int second, int size) : few_{first, second}, size_(size) {}
  EdgeFaces(const int* many, int size) : many_(many), size_(size) {}

  int size() const { return size_; }
  const int* begin() const { return many_ ? many_ : few_; }
  const int* end() const { return begin() + size_; }
  int operator[](int i) const { return begin()[i]; }

 private:
  const int* many_ = nullptr;
  int few_[2] = {};
  int size_;
};

/** The edges of a vertex, ascending: first those from lower vertices, which are listed, then those to higher ones, which follow each other.
 */
class VertexEdges {
 public:
  class Iterator {
   public:
    using difference_type = std::ptrdiff_t;
    using value_type = int;
    using pointer = const int*;
    using reference = int;
    using iterator_category = std::input_iterator_tag;

    Iterator(const VertexEdges& edges, int at) : edges_(&edges), at_(at) {}
    int operator*() const { return (*edges_)[at_]; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator==(const Iterator& other) const { return at_ == other.at_; }
    bool operator!=(const Iterator& other) const { return at_ != other.at_; }

   private:
    const VertexEdges* edges_;
    int at_;
  };

  VertexEdges(const int* listed, int listed_count, int next, int next_count)
      : listed_(listed), listed_count_(listed_count), next_(next), size_(listed_count + next_count) {}

  int size() const { return size_; }
  bool empty() const { return size_ == 0; }
  int operator[](int i) const { return i < listed_count_ ? listed_[i] : next_ + i - listed_count_; }
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size_}; }

 private:
  const int* listed_;
  int listed_count_, next_, size_;
};

/**
 * Features of a TriangleMesh: its vertices, its edges (each once, with any number of incident faces: none for a segment, one on a border,
 * two inside a surface, more where a soup is not a manifold) and its faces (elements with area). Nothing is assumed of winding.
 * A feature is flat, and owns nothing, where it lies inside a plane: an edge whose faces continue each other, a vertex with flat edges
 * only. A vertex inside a straight edge owns nothing either: the edge's parts speak for it. Made by the threads there are, whose number
 * does not show.
 * The topology takes some 36 bytes per triangle of a closed surface, 40 where some of it is flat; data that the mesh tells at once are not
 * held, so that functions that need them ask for the same mesh again.
 * Precondition: indices in range; fewer than 2^30 - 2 elements; coincident vertices are one, as
 * cleanMesh leaves them (else neighbours are not seen: more features, none lost).
 */
class MeshTopology {
 public:
  MeshTopology() = default;
  explicit MeshTopology(const TriangleMesh& mesh);

  /** Opposite in-plane directions within this sine are one plane: rounding, not noise. */
  static constexpr double FLAT_SINE = 1e-6;
  static constexpr int NO_EDGE = -1;

  int edgeCount() const { return static_cast<int>(edge_sides_.size()); }
  /** Vertices of the edge, the lower index first; edges are sorted by them. */
  std::array<int, 2> ends(const TriangleMesh& mesh, int edge) const {
    const int from = fromOf(mesh, edge), to = toOf(mesh, edge);
    return from < to ? std::array<int, 2>{from, to} : std::array<int, 2>{to, from};
  }
  int otherEnd(const TriangleMesh& mesh, int edge, int end) const { return fromOf(mesh, edge) ^ toOf(mesh, edge) ^ end; }
  EdgeFaces facesOf(int edge) const {
    const EdgeSides& sides = edge_sides_[edge];
    const std::uint32_t other = sides.other >> 2;
    if (sides.other & MANY) return {&many_faces_[other + 1], many_faces_[other]};
    return {static_cast<int>(sides.side >> 2), static_cast<int>(other), other == NO_FACE ? 0 : other == NO_SECOND ? 1 : 2};
  }
  VertexEdges edgesOf(int vertex) const {
    const int from_lower = lower_begin_[vertex], higher = higher_begin_[vertex];
    return {lower_edges_.data() + from_lower, lower_begin_[vertex + 1] - from_lower, higher, higher_begin_[vertex + 1] - higher};
  }
  /** Edge between corners k and k + 1, NO_EDGE if they coincide. */
  int edgeOf(int element, int k) const { return element_edges_[element][k]; }

  bool isFlatEdge(int edge) const { return edge_sides_[edge].other & FLAT; }
  bool isFlatVertex(int vertex) const { return vertex_kinds_[vertex] & FLAT_VERTEX; }
  /** Whether the vertex has two edges, but for flat ones, and they continue each other. */
  bool isStraightVertex(int vertex) const { return vertex_kinds_[vertex] & STRAIGHT_VERTEX; }
  /** First element of the plane that the element is part of, across flat edges. */
  int patchOf(int element) const { return patches_.empty() ? element : patches_[element]; }

  bool isFace(int element) const { return owned_[element] & FACE; }
  /** Unit normal by the element's winding; zero for elements without area: they are no faces. The same bits each time. */
  static Vector3 normal(const TriangleMesh& mesh, int element);

  /** Whether this element is the one that asks for its corner k / its edge between corners k and k + 1; never for flat ones. */
  bool ownsVertex(int element, int k) const { return owned_[element] >> k & 1; }
  bool ownsEdge(int element, int k) const { return owned_[element] >> (3 + k) & 1; }

  /** Bits k of the vertices / edges that the element asks for. */
  std::uint8_t ownedVertices(int element) const { return owned_[element] & 7; }
  std::uint8_t ownedEdges(int element) const { return owned_[element] >> 3 & 7; }

  std::size_t bytes() const;  ///< memory held

  /** Unit direction in the face's plane, square to the edge, into the face. @param face one of the edge's faces */
  Vector3 inward(const TriangleMesh& mesh, int edge, int face) const { return inward(mesh, edge, face, normal(mesh, face)); }
  /** The same where the face's normal is at hand. */
  Vector3 inward(const TriangleMesh& mesh, int edge, int face, const Vector3& face_normal) const;

 private:
  /** An edge is told by a side of its first face, or of its first element where it has none: 4 times the element, and the corner. */
  struct EdgeSides {
    EdgeSides() {}  // not set: there are millions
    EdgeSides(std::uint32_t side_of_first, std::uint32_t other_and_bits) : side(side_of_first), other(other_and_bits) {}

    std::uint32_t side;
    std::uint32_t other;  ///< 4 times the second face, NO_SECOND, NO_FACE or (MANY) the place of all in many_faces_; and FLAT, MANY
  };
  static constexpr std::uint32_t FLAT = 1, MANY = 2, NO_SECOND = (1u << 30) - 1, NO_FACE = NO_SECOND - 1;
  static constexpr std::uint8_t FLAT_VERTEX = 1, STRAIGHT_VERTEX = 2, FACE = 1 << 6;

  int fromOf(const TriangleMesh& mesh, int edge) const {
    const std::uint32_t side = edge_sides_[edge].side;
    return mesh.elements[side >> 2][side & 3];
  }
  int toOf(const TriangleMesh& mesh, int edge) const {
    const std::uint32_t side = edge_sides_[edge].side, corner = side & 3;
    return mesh.elements[side >> 2][corner == 2 ? 0 : corner + 1];
  }

  std::vector<Vector3> findFaces(const TriangleMesh& mesh);
  void findEdges(const SidesByVertex& by_vertex, int vertex_count);
  void findRings(const SidesByVertex& by_vertex, int vertex_count);
  bool findFlatness(const TriangleMesh& mesh, const std::vector<Vector3>& normals);
  void findPatches(int element_count);
  void findOwners(const TriangleMesh& mesh);
  bool isFlat(const TriangleMesh& mesh, int edge, const std::vector<Vector3>& normals) const;
  bool isStraight(const TriangleMesh& mesh, int vertex) const;

  std::vector<EdgeSides> edge_sides_;
  std::vector<int> many_faces_;                 // per edge with more than two faces: their number, then all
  std::vector<int> higher_begin_;               // size vertices + 1: edges to higher vertices
  std::vector<int> lower_begin_, lower_edges_;  // size vertices + 1: beginnings of lower_edges_ per vertex
  std::vector<Vector3i> element_edges_;         // per corner
  std::vector<std::uint8_t> vertex_kinds_;
  std::vector<int> patches_;         // empty: nothing is flat
  std::vector<std::uint8_t> owned_;  // bits 0-2 vertices, 3-5 edges, 6 FACE
};

}  // namespace blem_sim::geometry
