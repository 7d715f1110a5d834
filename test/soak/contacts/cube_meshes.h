// One cube of 10 cm, centred, in the triangles of different makers.
#pragma once

#include <cmath>

#include "geometry/gridded_box.h"
#include "geometry/random_shapes.h"
#include "support/broken_meshes.h"

namespace blem_sim {

inline geometry::TriangleMesh coarseCube(geometry::RandomShapes&) { return geometry::boxMesh(Vector3::Constant(0.1)); }

/** 1,200 triangles, the inner vertices of each side strewn about in its plane. */
inline geometry::TriangleMesh retessellatedCube(geometry::RandomShapes& random) {
  geometry::TriangleMesh mesh = geometry::griddedBox(Vector3::Constant(0.1), Vector3i::Constant(10));
  for (Vector3& v : mesh.vertices) {
    if ((v.cwiseAbs().array() > 0.0499).count() > 1) continue;
    for (int k = 0; k < 3; ++k)
      if (std::abs(v[k]) < 0.0499) v[k] += random.uniform(-0.003, 0.003);
  }
  return mesh;
}

/** Every triangle with corners of its own, each off by up to 10 um along every axis. */
inline geometry::TriangleMesh crackedCube(geometry::RandomShapes& random) {
  return crackedCopy(geometry::boxMesh(Vector3::Constant(0.1)), 1e-5, random);
}

/** Each side of another tessellation, not conforming with its neighbours along the cube's edges. */
inline geometry::TriangleMesh tJunctionCube(geometry::RandomShapes& random) {
  return geometry::boxOfGrids(Vector3::Constant(0.1), [&random](int, double u, double v) {
    const int along_v = random.integer(1, 7), along_u = random.integer(1, 7);
    return geometry::gridMesh(u, v, along_u, along_v);
  });
}

}  // namespace blem_sim
