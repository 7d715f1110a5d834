// Copies of a mesh that are broken as files are broken: other orders, other windings, doubles, cracks, T-junctions.
#pragma once

#include <numeric>
#include <utility>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"
#include "geometry/random_shapes.h"

namespace blem_sim {

/** Vertices and triangles in another order, some triangles wound the other way. */
inline geometry::TriangleMesh shuffledCopy(const geometry::TriangleMesh& mesh, geometry::RandomShapes& random) {
  geometry::TriangleMesh copy = mesh;
  for (std::size_t i = copy.elements.size(); i > 1; --i)
    std::swap(copy.elements[i - 1], copy.elements[random.integer(0, static_cast<int>(i) - 1)]);
  std::vector<int> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.integer(0, static_cast<int>(i) - 1)]);
  for (std::size_t i = 0; i < order.size(); ++i) copy.vertices[order[i]] = mesh.vertices[i];
  for (Vector3i& e : copy.elements) e = {order[e[0]], order[e[1]], order[e[2]]};
  return copy;
}

/** A copy with half of the triangles wound the other way. */
inline geometry::TriangleMesh rewoundCopy(const geometry::TriangleMesh& mesh, geometry::RandomShapes& random) {
  geometry::TriangleMesh copy = mesh;
  for (Vector3i& e : copy.elements) {
    if (random.integer(0, 1)) std::swap(e[1], e[2]);
  }
  return copy;
}

/** Every second triangle once more, wound the other way. */
inline geometry::TriangleMesh doubledCopy(const geometry::TriangleMesh& mesh) {
  geometry::TriangleMesh copy = mesh;
  for (std::size_t i = 0; i < mesh.elements.size(); i += 2) {
    const Vector3i e = mesh.elements[i];
    copy.elements.push_back({e[2], e[1], e[0]});
  }
  return copy;
}

/** Every triangle with vertices of its own, each coordinate off by up to `amplitude` [m]. */
inline geometry::TriangleMesh crackedCopy(const geometry::TriangleMesh& mesh, double amplitude, geometry::RandomShapes& random) {
  geometry::TriangleMesh copy;
  for (const Vector3i& e : mesh.elements) {
    const int first = static_cast<int>(copy.vertices.size());
    for (int k = 0; k < 3; ++k) {
      const Vector3 off = amplitude > 0 ? random.point(amplitude) : Vector3::Zero();
      copy.vertices.push_back(mesh.vertices[e[k]] + off);
    }
    copy.elements.push_back({first, first + 1, first + 2});
  }
  return copy;
}

/** Every second triangle split in four, its neighbours not. */
inline geometry::TriangleMesh tJunctionCopy(const geometry::TriangleMesh& mesh) {
  geometry::TriangleMesh copy;
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    geometry::TriangleMesh one;
    for (int k = 0; k < 3; ++k) one.vertices.push_back(mesh.vertices[mesh.elements[i][k]]);
    one.elements = {{0, 1, 2}};
    if (i % 2) one = geometry::subdivided(one, 1);
    const int first = static_cast<int>(copy.vertices.size());
    copy.vertices.insert(copy.vertices.end(), one.vertices.begin(), one.vertices.end());
    for (const Vector3i& e : one.elements) copy.elements.push_back(e + Vector3i::Constant(first));
  }
  return copy;
}

}  // namespace blem_sim
