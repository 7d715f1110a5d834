// One cube of 10 cm, centred, in the triangles of different makers.
#pragma once

#include "geometry/random_shapes.h"

namespace blem_sim {

inline TriangleMesh coarseCube(RandomShapes&) { return boxMesh(Vector3::Constant(0.1)); }

/** Grids of n x n squares on every side, each with its own vertices. */
inline TriangleMesh griddedCube(int n) {
  TriangleMesh mesh;
  const TriangleMesh side = gridMesh(0.1, 0.1, n, n);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double height : {-0.05, 0.05}) {
      const int first = static_cast<int>(mesh.vertices.size());
      for (const Vector3& p : side.vertices) {
        Vector3 q;
        q[axis] = height;
        q[(axis + 1) % 3] = p.x();
        q[(axis + 2) % 3] = p.y();
        mesh.vertices.push_back(q);
      }
      for (const Vector3i& e : side.elements) mesh.elements.push_back(e + Vector3i::Constant(first));
    }
  }
  return mesh;
}

/** 1,200 triangles, the inner vertices of each side strewn about in its plane. */
inline TriangleMesh retessellatedCube(RandomShapes& random) {
  TriangleMesh mesh = griddedCube(10);
  for (Vector3& v : mesh.vertices) {
    if ((v.cwiseAbs().array() > 0.0499).count() > 1) continue;
    for (int k = 0; k < 3; ++k)
      if (std::abs(v[k]) < 0.0499) v[k] += random.uniform(-0.003, 0.003);
  }
  return mesh;
}

/** Every triangle with corners of its own, each off by up to 10 um along every axis. */
inline TriangleMesh crackedCube(RandomShapes& random) {
  const TriangleMesh cube = boxMesh(Vector3::Constant(0.1));
  TriangleMesh mesh;
  for (const Vector3i& e : cube.elements) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(cube.vertices[e[k]] + random.point(1e-5));
    mesh.elements.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/** Each side of another tessellation, not conforming with its neighbours along the cube's edges. */
inline TriangleMesh tJunctionCube(RandomShapes& random) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double height : {-0.05, 0.05}) {
      const TriangleMesh side = gridMesh(0.1, 0.1, random.integer(1, 7), random.integer(1, 7));
      const int first = static_cast<int>(mesh.vertices.size());
      for (const Vector3& p : side.vertices) {
        Vector3 q;
        q[axis] = height;
        q[(axis + 1) % 3] = p.x();
        q[(axis + 2) % 3] = p.y();
        mesh.vertices.push_back(q);
      }
      for (const Vector3i& e : side.elements) mesh.elements.push_back(e + Vector3i::Constant(first));
    }
  }
  return mesh;
}

}  // namespace blem_sim
