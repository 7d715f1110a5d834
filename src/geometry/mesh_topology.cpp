#include "blem_sim/geometry/mesh_topology.h"

#include <algorithm>
#include <cmath>

namespace blem_sim {
namespace {

/** A triangle lower than this part of its longest side is its sides: its normal would be rounding, and its inside is as near as they. */
constexpr double MIN_RELATIVE_HEIGHT = 1e-10;

/** Unit normal, from the two shorter sides, which give the better one of a needle; zero without area. */
Vector3 unitNormal(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a, bc = c - b, ca = a - c;
  const double ab2 = ab.squaredNorm(), bc2 = bc.squaredNorm(), ca2 = ca.squaredNorm();
  const Vector3 n = ab2 >= bc2 && ab2 >= ca2 ? bc.cross(ca) : bc2 >= ca2 ? ca.cross(ab) : ab.cross(bc);
  const double norm = n.norm();
  const bool has_area = norm > MIN_RELATIVE_HEIGHT * std::max({ab2, bc2, ca2});
  return has_area ? Vector3(n / norm) : Vector3(Vector3::Zero());
}

/** Turns counts at [i + 1] into the beginnings of groups. */
void accumulate(std::vector<int>* counts) {
  for (std::size_t i = 1; i < counts->size(); ++i) (*counts)[i] += (*counts)[i - 1];
}

/** Sides of all elements, 3 * element + k, grouped by their lower vertex and sorted by the higher one: (higher vertex << 32) | side. */
struct SidesByVertex {
  std::vector<int> begin;
  std::vector<std::uint64_t> sides;

  explicit SidesByVertex(const TriangleMesh& mesh) : begin(mesh.vertices.size() + 1, 0) {
    const auto forEachSide = [&mesh](auto&& visit) {
      for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
        const Vector3i& e = mesh.elements[i];
        for (int k = 0; k < 3; ++k) {
          const int from = e[k], to = e[(k + 1) % 3];
          if (from != to) visit(std::min(from, to), static_cast<std::uint64_t>(std::max(from, to)) << 32 | (3 * i + k));
        }
      }
    };
    forEachSide([this](int vertex, std::uint64_t) { ++begin[vertex + 1]; });
    accumulate(&begin);
    sides.resize(begin.back());
    std::vector<int> next(begin.begin(), begin.end() - 1);
    forEachSide([this, &next](int vertex, std::uint64_t side) { sides[next[vertex]++] = side; });
    for (std::size_t v = 0; v + 1 < begin.size(); ++v) std::sort(sides.begin() + begin[v], sides.begin() + begin[v + 1]);
  }
};

int root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

MeshTopology::MeshTopology(const TriangleMesh& mesh) {
  normals.reserve(mesh.elements.size());
  for (const Vector3i& e : mesh.elements) normals.push_back(unitNormal(mesh.vertices[e[0]], mesh.vertices[e[1]], mesh.vertices[e[2]]));
  findEdges(mesh);
  findRings(static_cast<int>(mesh.vertices.size()));
  findFlatness(mesh);
  findPatches();
  findOwners(mesh);
}

Vector3 MeshTopology::inward(const TriangleMesh& mesh, int edge, int face) const {
  const int start = edges[edge][0], end = edges[edge][1];
  const int opposite = mesh.elements[face].sum() - start - end;
  const Vector3 across = normals[face].cross(mesh.vertices[end] - mesh.vertices[start]).normalized();
  return across.dot(mesh.vertices[opposite] - mesh.vertices[start]) < 0 ? Vector3(-across) : across;
}

void MeshTopology::findEdges(const TriangleMesh& mesh) {
  element_edges.assign(mesh.elements.size(), {NO_EDGE, NO_EDGE, NO_EDGE});
  const SidesByVertex by_vertex(mesh);
  edges.reserve(by_vertex.sides.size() / 2);
  edge_face_begin.reserve(by_vertex.sides.size() / 2 + 1);
  edge_faces.reserve(by_vertex.sides.size());
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    for (int i = by_vertex.begin[v]; i < by_vertex.begin[v + 1]; ++i) {
      const int other = static_cast<int>(by_vertex.sides[i] >> 32);
      if (i == by_vertex.begin[v] || edges.back()[1] != other) {
        edges.push_back({v, other});
        edge_face_begin.push_back(static_cast<int>(edge_faces.size()));
      }
      const std::uint32_t side = static_cast<std::uint32_t>(by_vertex.sides[i]);
      const int element = static_cast<int>(side / 3);
      element_edges[element][side % 3] = static_cast<int>(edges.size()) - 1;
      if (isFace(element)) edge_faces.push_back(element);
    }
  }
  edge_face_begin.push_back(static_cast<int>(edge_faces.size()));
}

void MeshTopology::findRings(int vertex_count) {
  vertex_edge_begin.assign(vertex_count + 1, 0);
  for (const std::array<int, 2>& edge : edges) {
    for (const int vertex : edge) ++vertex_edge_begin[vertex + 1];
  }
  accumulate(&vertex_edge_begin);
  vertex_edges.resize(vertex_edge_begin.back());
  std::vector<int> next(vertex_edge_begin.begin(), vertex_edge_begin.end() - 1);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (const int vertex : edges[i]) vertex_edges[next[vertex]++] = static_cast<int>(i);
  }
}

bool MeshTopology::isFlat(const TriangleMesh& mesh, int edge) const {
  const int begin = edge_face_begin[edge], end = edge_face_begin[edge + 1];
  if (end - begin < 2) return false;
  // Faces may be there more than once, but all must lie on the two halves of one plane, some on each.
  const Vector3 first = inward(mesh, edge, edge_faces[begin]);
  bool continued = false;
  for (int i = begin + 1; i < end; ++i) {
    const Vector3 u = inward(mesh, edge, edge_faces[i]);
    const bool opposite = u.dot(first) < 0;
    if ((opposite ? Vector3(u + first) : Vector3(u - first)).norm() > FLAT_SINE) return false;
    continued = continued || opposite;
  }
  return continued;
}

bool MeshTopology::isStraight(const TriangleMesh& mesh, int vertex) const {
  Vector3 sum = Vector3::Zero();
  int sharp = 0;
  for (int i = vertex_edge_begin[vertex]; i < vertex_edge_begin[vertex + 1]; ++i) {
    const int edge = vertex_edges[i];
    if (edge_flat[edge]) continue;
    sum += (mesh.vertices[edges[edge][edges[edge][0] == vertex]] - mesh.vertices[vertex]).normalized();
    ++sharp;
  }
  return sharp == 2 && sum.norm() <= FLAT_SINE;
}

void MeshTopology::findFlatness(const TriangleMesh& mesh) {
  edge_flat.resize(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) edge_flat[i] = isFlat(mesh, static_cast<int>(i));
  vertex_flat.resize(mesh.vertices.size());
  vertex_straight.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto begin = vertex_edges.begin() + vertex_edge_begin[v], end = vertex_edges.begin() + vertex_edge_begin[v + 1];
    vertex_flat[v] = begin != end && std::all_of(begin, end, [this](int edge) { return edge_flat[edge] != 0; });
    vertex_straight[v] = isStraight(mesh, static_cast<int>(v));
  }
}

void MeshTopology::findPatches() {
  patch.resize(normals.size());
  for (std::size_t i = 0; i < patch.size(); ++i) patch[i] = static_cast<int>(i);
  for (std::size_t edge = 0; edge < edges.size(); ++edge) {
    if (!edge_flat[edge]) continue;
    for (int i = edge_face_begin[edge] + 1; i < edge_face_begin[edge + 1]; ++i) {
      const int a = root(patch, edge_faces[i - 1]), b = root(patch, edge_faces[i]);
      patch[std::max(a, b)] = std::min(a, b);
    }
  }
  for (std::size_t i = 0; i < patch.size(); ++i) patch[i] = root(patch, static_cast<int>(i));
}

void MeshTopology::findOwners(const TriangleMesh& mesh) {
  std::vector<std::uint8_t> vertex_taken = vertex_flat, edge_taken = edge_flat;
  for (std::size_t v = 0; v < vertex_taken.size(); ++v) vertex_taken[v] |= vertex_straight[v];
  owned_.assign(mesh.elements.size(), 0);
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.elements[i][k], edge = element_edges[i][k];
      if (!vertex_taken[vertex]) owned_[i] |= 1 << k;
      vertex_taken[vertex] = true;
      if (edge == NO_EDGE) continue;
      if (!edge_taken[edge]) owned_[i] |= 1 << (3 + k);
      edge_taken[edge] = true;
    }
  }
}

}  // namespace blem_sim
