#include "blem_sim/geometry/mesh_topology.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "grouped.h"
#include "sides_by_vertex.h"

namespace blem_sim {
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

int root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

MeshTopology::MeshTopology(const TriangleMesh& mesh) {
  normals.resize(mesh.elements.size());
  tbb::parallel_for(std::size_t{0}, normals.size(), [&](std::size_t i) {
    const Vector3i& e = mesh.elements[i];
    normals[i] = unitNormal(mesh.vertices[e[0]], mesh.vertices[e[1]], mesh.vertices[e[2]]);
  });
  findEdges(mesh);
  findRings(static_cast<int>(mesh.vertices.size()));
  findFlatness(mesh);
  findPatches();
  findOwners(mesh);
}

std::size_t MeshTopology::bytes() const {
  const auto of = [](const auto&... arrays) { return ((arrays.capacity() * sizeof(arrays[0])) + ...); };
  return of(edges, edge_face_begin, edge_faces, vertex_edge_begin, vertex_edges, element_edges, normals, edge_flat, vertex_flat,
            vertex_straight, patch, owned_);
}

Vector3 MeshTopology::inward(const TriangleMesh& mesh, int edge, int face) const {
  const int start = edges[edge][0], end = edges[edge][1];
  const int opposite = mesh.elements[face].sum() - start - end;
  const Vector3 across = normals[face].cross(mesh.vertices[end] - mesh.vertices[start]).normalized();
  return across.dot(mesh.vertices[opposite] - mesh.vertices[start]) < 0 ? Vector3(-across) : across;
}

void MeshTopology::findEdges(const TriangleMesh& mesh) {
  const SidesByVertex by_vertex(mesh);
  const int vertices = static_cast<int>(mesh.vertices.size());
  const auto isOfFace = [this](const Side& side) { return isFace(side.element()); };
  // Where the edges of a vertex begin, and their faces: first how many there are.
  std::vector<int> edge_begin(vertices + 1, 0), face_begin(vertices + 1, 0);
  tbb::parallel_for(0, vertices, [&](int v) {
    visitEdges(by_vertex, v, [&](const Side* first, const Side* last) {
      ++edge_begin[v + 1];
      face_begin[v + 1] += static_cast<int>(std::count_if(first, last, isOfFace));
    });
  });
  accumulate(&edge_begin);
  accumulate(&face_begin);
  element_edges.assign(mesh.elements.size(), {NO_EDGE, NO_EDGE, NO_EDGE});
  edges.resize(edge_begin.back());
  edge_face_begin.resize(edges.size() + 1);
  edge_face_begin.back() = face_begin.back();
  edge_faces.resize(face_begin.back());
  tbb::parallel_for(0, vertices, [&](int v) {
    int edge = edge_begin[v], face = face_begin[v];
    visitEdges(by_vertex, v, [&](const Side* first, const Side* last) {
      edges[edge] = {v, first->higher()};
      edge_face_begin[edge] = face;
      for (const Side* side = first; side != last; ++side) {
        element_edges[side->element()][side->corner()] = edge;
        if (isOfFace(*side)) edge_faces[face++] = side->element();
      }
      ++edge;
    });
  });
}

void MeshTopology::findRings(int vertex_count) {
  const auto visitEnds = [this](int edge, auto&& visit) {
    for (const int vertex : edges[edge]) visit(vertex, edge);
  };
  vertex_edge_begin = grouped(static_cast<int>(edges.size()), vertex_count, visitEnds, [this](std::size_t count) {
    vertex_edges.resize(count);
    return vertex_edges.data();
  });
}

bool MeshTopology::isFlat(const TriangleMesh& mesh, int edge) const {
  const int begin = edge_face_begin[edge], end = edge_face_begin[edge + 1];
  if (end - begin < 2) return false;
  // Faces may be there more than once, but all must lie on the two halves of one plane, some on each.
  const Vector3& first_normal = normals[edge_faces[begin]];
  for (int i = begin + 1; i < end; ++i) {
    if (std::abs(first_normal.dot(normals[edge_faces[i]])) < CLEARLY_BENT) return false;
  }
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
  const auto begin = vertex_edges.begin() + vertex_edge_begin[vertex], end = vertex_edges.begin() + vertex_edge_begin[vertex + 1];
  if (std::count_if(begin, end, [this](int edge) { return edge_flat[edge] == 0; }) != 2) return false;
  Vector3 sum = Vector3::Zero();
  for (auto edge = begin; edge != end; ++edge) {
    if (edge_flat[*edge]) continue;
    sum += (mesh.vertices[edges[*edge][edges[*edge][0] == vertex]] - mesh.vertices[vertex]).normalized();
  }
  return sum.norm() <= FLAT_SINE;
}

void MeshTopology::findFlatness(const TriangleMesh& mesh) {
  edge_flat.resize(edges.size());
  tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t i) { edge_flat[i] = isFlat(mesh, static_cast<int>(i)); });
  vertex_flat.resize(mesh.vertices.size());
  vertex_straight.resize(mesh.vertices.size());
  tbb::parallel_for(std::size_t{0}, mesh.vertices.size(), [&](std::size_t v) {
    const auto begin = vertex_edges.begin() + vertex_edge_begin[v], end = vertex_edges.begin() + vertex_edge_begin[v + 1];
    vertex_flat[v] = begin != end && std::all_of(begin, end, [this](int edge) { return edge_flat[edge] != 0; });
    vertex_straight[v] = isStraight(mesh, static_cast<int>(v));
  });
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
