// Moves a surface inwards by its boundary layer, so that the layer's outside is where the surface was [Hauser 2013, 3.3].
#pragma once

#include <string>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

/** Result of shrinkMesh: vertices that moved, and how well the layer's outside meets the old surface. */
struct MeshShrinking {
  std::string refused;   ///< why nothing moved; empty if it did
  int moved = 0;         ///< vertices that moved as far as their planes ask for
  int held_back = 0;     ///< vertices that moved less, where the mesh is thin or sharp
  double excess = 0;     ///< [m] by how much the layer's outside stands out of the old surface's planes, at most; r where nothing moved
  double shortfall = 0;  ///< [m] by how much the layer's outside lies inside them, at most
};

/**
 * Moves every vertex inwards so that the planes of its triangles move by r; where they cannot all, in the mean square by the triangles'
 * angles. No vertex moves farther than 3 r, so that spikes stay. Then no triangle may have turned over (or by more than 60 degrees) and no
 * triangle may cross another, unless it did before: vertices where one does are held back, by halves, and stay where they are
 * if that is not enough.
 * The mesh must be closed and wound consistently, its inside being where the enclosed volume is positive; else it comes back as it is and
 * `what` says why. Deterministic. Elements keep their order and corners.
 * @param r [m] >= 0
 */
TriangleMesh shrinkMesh(const TriangleMesh& mesh, double r, MeshShrinking* what);

}  // namespace blem_sim::geometry
