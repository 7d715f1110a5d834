// A mesh for ODE's OPCODE.
#pragma once

#include <ode/ode.h>

#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim {

/** A mesh for ODE, which must outlive the geoms made of it. */
struct OdeMesh {
  explicit OdeMesh(const geometry::TriangleMesh& mesh) : data(dGeomTriMeshDataCreate()) {
    for (const Vector3& v : mesh.vertices) vertices.insert(vertices.end(), {v.x(), v.y(), v.z()});
    for (const Vector3i& e : mesh.elements)
      for (int k = 0; k < 3; ++k) indices.push_back(static_cast<dTriIndex>(e[k]));
    dGeomTriMeshDataBuildDouble(data, vertices.data(), 3 * sizeof(double), static_cast<int>(mesh.vertices.size()), indices.data(),
                                static_cast<int>(indices.size()), 3 * sizeof(dTriIndex));
  }
  ~OdeMesh() { dGeomTriMeshDataDestroy(data); }
  OdeMesh(const OdeMesh&) = delete;
  OdeMesh& operator=(const OdeMesh&) = delete;
  std::vector<double> vertices;
  std::vector<dTriIndex> indices;
  dTriMeshDataID data;
};

/** Initialises ODE, once for the rest of the program. */
inline bool initialiseOde() {
  static const bool initialised = dInitODE2(0) != 0;
  return initialised;
}

}  // namespace blem_sim
