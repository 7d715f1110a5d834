// Boxes whose sides are grids.
#pragma once

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

/** Closed box, centred; every side has vertices of its own. @param grid side's grid from its lengths [m], called per side with the axis
 * that it is square to: grid(axis, size_u, size_v) with u, v the axes that follow */
template <typename Grid>
TriangleMesh boxOfGrids(const Vector3& size, Grid&& grid) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const double height : {-0.5 * size[axis], 0.5 * size[axis]}) {
      const TriangleMesh side = grid(axis, size[u], size[v]);
      const int first = static_cast<int>(mesh.vertices.size());
      for (const Vector3& p : side.vertices) {
        Vector3 q;
        q[axis] = height;
        q[u] = p.x();
        q[v] = p.y();
        mesh.vertices.push_back(q);
      }
      for (const Vector3i& e : side.elements) mesh.elements.push_back(e + Vector3i::Constant(first));
    }
  }
  return mesh;
}

/** The same with n squares along each axis. */
inline TriangleMesh griddedBox(const Vector3& size, const Vector3i& n) {
  return boxOfGrids(size, [&n](int axis, double u, double v) { return gridMesh(u, v, n[(axis + 1) % 3], n[(axis + 2) % 3]); });
}

}  // namespace blem_sim::geometry
