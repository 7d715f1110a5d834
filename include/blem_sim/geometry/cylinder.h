// The cylinder that a mesh of flat sides stands for.
#pragma once

#include <cmath>
#include <optional>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

/** A solid cylinder; vertices 2 i and 2 i + 1 of its mesh (cylinderMesh) lie on its lower and upper rim. */
struct Cylinder {
  Pose X_GK = Pose::Identity();  ///< its frame in the mesh's: z along the axis, origin in the middle, x towards the mesh's first line
  double radius = 0;             ///< [m]
  double half_length = 0;        ///< [m]
  int sides = 0;                 ///< of the mesh

  /** [m] By how much the mantle lies outside of the mesh in the middle of a side. */
  double bulge() const { return radius * (1 - std::cos(M_PI / sides)); }
};

/** The cylinder behind a mesh by cylinderMesh that was moved or turned; none if its rims have no common radius. */
std::optional<Cylinder> cylinderBehind(const TriangleMesh& mesh);

/** Largest layer [m] that a cylinder has room for inside: half of its radius and of its half length. */
double widestLayerInside(const Cylinder& cylinder);

/** A cylinder less a layer inside, and its mesh. */
struct CylinderCore {
  TriangleMesh mesh;
  Cylinder cylinder;
};

/** @param mesh of the cylinder @param layer [m] thickness, at most widestLayerInside */
CylinderCore coreOf(const TriangleMesh& mesh, const Cylinder& cylinder, double layer);

}  // namespace blem_sim::geometry
