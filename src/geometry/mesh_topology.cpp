#include "blem_sim/geometry/mesh_topology.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "blem_sim/geometry/for_all.h"
#include "sides_by_vertex.h"
#include "threads/disjoint_sets.h"
#include "threads/grouped.h"

namespace blem_sim::geometry {
namespace {

/** A triangle lower than this part of its longest side is its sides: its normal would be rounding, and its inside is as near as they. */
constexpr double MIN_RELATIVE_HEIGHT = 1e-10;

/** Cosine of a bend that is one without a closer look: FLAT_SINE and the rounding of a needle's normal are far below it. */
constexpr double CLEARLY_BENT = 1 - 1e-8;

/** Unit normal, from the two shorter sides, which give the better one of a needle; zero without area. */
Vector3 unitNormal(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a, bc = c - b, ca = a - c;
  const double ab2 = ab.squaredNorm(), bc2 = bc.squaredNorm(), ca2 = ca.squaredNorm();
  const Vector3 n = ab2 >= bc2 && ab2 >= ca2 ? bc.cross(ca) : bc2 >= ca2 ? ca.cross(ab) : ab.cross(bc);
  const double norm = n.norm();
  const bool has_area = norm > MIN_RELATIVE_HEIGHT * std::max({ab2, bc2, ca2});
  return has_area ? Vector3(n / norm) : Vector3(Vector3::Zero());
}

}  // namespace

MeshTopology::MeshTopology(const TriangleMesh& mesh) {
  const std::vector<Vector3> normals = findFaces(mesh);
  const int vertices = static_cast<int>(mesh.vertices.size());
  {
    const SidesByVertex by_vertex(mesh);
    findEdges(by_vertex, vertices);
    findRings(by_vertex, vertices);
  }
  if (findFlatness(mesh, normals)) findPatches(static_cast<int>(mesh.elements.size()));
  findOwners(mesh);
}

Vector3 MeshTopology::normal(const TriangleMesh& mesh, int element) {
  const Vector3i& e = mesh.elements[element];
  return unitNormal(mesh.vertices[e[0]], mesh.vertices[e[1]], mesh.vertices[e[2]]);
}

std::size_t MeshTopology::bytes() const {
  const auto of = [](const auto&... arrays) { return ((arrays.capacity() * sizeof(arrays[0])) + ...); };
  return of(edge_sides_, many_faces_, higher_begin_, lower_begin_, lower_edges_, element_edges_, vertex_kinds_, patches_, owned_);
}

Vector3 MeshTopology::inward(const TriangleMesh& mesh, int edge, int face, const Vector3& face_normal) const {
  const auto [start, end] = ends(mesh, edge);
  const int opposite = mesh.elements[face].sum() - start - end;
  const Vector3 across = face_normal.cross(mesh.vertices[end] - mesh.vertices[start]).normalized();
  return across.dot(mesh.vertices[opposite] - mesh.vertices[start]) < 0 ? Vector3(-across) : across;
}

/** @return the normals, while they are at hand */
std::vector<Vector3> MeshTopology::findFaces(const TriangleMesh& mesh) {
  std::vector<Vector3> normals(mesh.elements.size());
  owned_.resize(normals.size());
  element_edges_.resize(normals.size());
  forAll(normals.size(), [&](std::size_t i) {
    element_edges_[i].setConstant(NO_EDGE);
    normals[i] = normal(mesh, static_cast<int>(i));
    owned_[i] = normals[i].isZero(0) ? 0 : FACE;
  });
  return normals;
}

void MeshTopology::findEdges(const SidesByVertex& by_vertex, int vertex_count) {
  const auto isOfFace = [this](const Side& side) { return isFace(side.element()); };
  const auto facesAmong = [&](const Side* first, const Side* last) { return static_cast<int>(std::count_if(first, last, isOfFace)); };
  // Beginnings of the edges of a vertex, and of the lists of many faces: first their lengths.
  std::vector<int> many_begin(vertex_count + 1, 0);
  higher_begin_.assign(vertex_count + 1, 0);
  forAll(vertex_count, [&](int v) {
    visitEdges(by_vertex, v, [&](const Side* first, const Side* last) {
      ++higher_begin_[v + 1];
      const int faces = last - first > 2 ? facesAmong(first, last) : 0;
      if (faces > 2) many_begin[v + 1] += 1 + faces;
    });
  });
  accumulate(&higher_begin_);
  accumulate(&many_begin);
  edge_sides_.resize(higher_begin_.back());
  many_faces_.resize(many_begin.back());
  forAll(vertex_count, [&](int v) {
    int edge = higher_begin_[v], many = many_begin[v];
    visitEdges(by_vertex, v, [&](const Side* first, const Side* last) {
      for (const Side* side = first; side != last; ++side) element_edges_[side->element()][side->corner()] = edge;
      const Side* const face = std::find_if(first, last, isOfFace);
      const Side* const second = face == last ? last : std::find_if(face + 1, last, isOfFace);
      const Side& teller = face == last ? *first : *face;
      const int faces = second == last ? 0 : facesAmong(first, last);
      const std::uint32_t other = faces > 2        ? static_cast<std::uint32_t>(many)
                                  : face == last   ? NO_FACE
                                  : second == last ? NO_SECOND
                                                   : static_cast<std::uint32_t>(second->element());
      edge_sides_[edge++] = {static_cast<std::uint32_t>(teller.element()) << 2 | static_cast<std::uint32_t>(teller.corner()),
                             other << 2 | (faces > 2 ? MANY : 0)};
      if (faces <= 2) return;
      many_faces_[many++] = faces;
      for (const Side* side = face; side != last; ++side) {
        if (isOfFace(*side)) many_faces_[many++] = side->element();
      }
    });
  });
}

void MeshTopology::findRings(const SidesByVertex& by_vertex, int vertex_count) {
  const auto visitHigherEnds = [&](int v, auto&& visit) {
    int edge = higher_begin_[v];
    visitEdges(by_vertex, v, [&](const Side* first, const Side*) { visit(first->higher(), edge++); });
  };
  lower_begin_ = grouped(vertex_count, vertex_count, visitHigherEnds, [this](std::size_t count) {
    lower_edges_.resize(count);
    return lower_edges_.data();
  });
}

bool MeshTopology::isFlat(const TriangleMesh& mesh, int edge, const std::vector<Vector3>& normals) const {
  const EdgeFaces faces = facesOf(edge);
  if (faces.size() < 2) return false;
  // Faces may be there more than once, but all must lie on the two halves of one plane, some on each.
  const Vector3& first_normal = normals[faces[0]];
  for (int i = 1; i < faces.size(); ++i) {
    if (std::abs(first_normal.dot(normals[faces[i]])) < CLEARLY_BENT) return false;
  }
  const Vector3 first = inward(mesh, edge, faces[0], first_normal);
  bool continued = false;
  for (int i = 1; i < faces.size(); ++i) {
    const Vector3 u = inward(mesh, edge, faces[i], normals[faces[i]]);
    const bool opposite = u.dot(first) < 0;
    if ((opposite ? Vector3(u + first) : Vector3(u - first)).norm() > FLAT_SINE) return false;
    continued = continued || opposite;
  }
  return continued;
}

bool MeshTopology::isStraight(const TriangleMesh& mesh, int vertex) const {
  const VertexEdges around = edgesOf(vertex);
  if (std::count_if(around.begin(), around.end(), [this](int edge) { return !isFlatEdge(edge); }) != 2) return false;
  Vector3 sum = Vector3::Zero();
  for (const int edge : around) {
    if (!isFlatEdge(edge)) sum += (mesh.vertices[otherEnd(mesh, edge, vertex)] - mesh.vertices[vertex]).normalized();
  }
  return sum.norm() <= FLAT_SINE;
}

/** @return whether an edge is flat */
bool MeshTopology::findFlatness(const TriangleMesh& mesh, const std::vector<Vector3>& normals) {
  std::atomic<bool> some{false};
  forAll(edgeCount(), [&](int edge) {
    if (!isFlat(mesh, edge, normals)) return;
    edge_sides_[edge].other |= FLAT;
    if (!some.load(std::memory_order_relaxed)) some.store(true, std::memory_order_relaxed);
  });
  vertex_kinds_.resize(mesh.vertices.size());
  forAll(mesh.vertices.size(), [&](std::size_t v) {
    const int vertex = static_cast<int>(v);
    const VertexEdges around = edgesOf(vertex);
    const bool flat = !around.empty() && std::all_of(around.begin(), around.end(), [this](int edge) { return isFlatEdge(edge); });
    vertex_kinds_[v] = (flat ? FLAT_VERTEX : 0) | (isStraight(mesh, vertex) ? STRAIGHT_VERTEX : 0);
  });
  return some;
}

void MeshTopology::findPatches(int element_count) {
  DisjointSets sets(element_count);
  forAll(edgeCount(), [&](int edge) {
    if (!isFlatEdge(edge)) return;
    const EdgeFaces faces = facesOf(edge);
    for (int i = 1; i < faces.size(); ++i) sets.join(faces[i - 1], faces[i]);
  });
  patches_.resize(element_count);
  forAll(element_count, [&](int i) { patches_[i] = sets.first(i); });
}

void MeshTopology::findOwners(const TriangleMesh& mesh) {
  std::vector<std::uint8_t> vertex_taken = vertex_kinds_, edge_taken(edge_sides_.size());
  forAll(edgeCount(), [&](int edge) { edge_taken[edge] = isFlatEdge(edge); });
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.elements[i][k], edge = element_edges_[i][k];
      if (!vertex_taken[vertex]) owned_[i] |= 1 << k;
      vertex_taken[vertex] = true;
      if (edge == NO_EDGE) continue;
      if (!edge_taken[edge]) owned_[i] |= 1 << (3 + k);
      edge_taken[edge] = true;
    }
  }
}

}  // namespace blem_sim::geometry
