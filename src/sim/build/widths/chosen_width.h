// Boundary widths that suit an object: `boundary_width: auto`.
#pragma once

#include <limits>
#include <string>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::sim {

/** A geometry and its use, as far as they decide on its boundary width. */
struct WidthNeeds {
  bool moves = false;                                          ///< false: environments
  bool drawn = false;                                          ///< true: shapes of a URDF, which have no noise
  double weight = 0;                                           ///< [N] that a contact may have to carry
  double side = 0;                                             ///< [m] of smallestSide; 0: unknown
  double noise = 0;                                            ///< [m] of scanNoise
  double stiffness = std::numeric_limits<double>::infinity();  ///< [N/m] of its surface
  double time_step = 0;                                        ///< [s]
};

struct ChosenWidth {
  double width = 0;  ///< [m]
  std::string why;
};

/** Smallest side [m] of the bounding box; of an open surface, which may be a flat sheet, the middle one. */
double smallestSide(const geometry::TriangleMesh& mesh, bool closed);

inline WidthNeeds needsOfEnvironment() { return {}; }
inline WidthNeeds needsOfMeshObject(double weight) { return {true, false, weight}; }
inline WidthNeeds needsOfLink(double weight) { return {true, true, weight}; }

/**
 * The largest of these needs: three standard deviations of noise, so that what rests on one peak is held by the layer of others; and for
 * what moves, the way of 1 m/s in a time step, by which layers meet before meshes do, and twice what its weight presses a soft surface in.
 * Capped at a twentieth of the smallest side of what moves, so that it keeps its shape, and at 5 mm for environments.
 */
ChosenWidth chosenWidth(const WidthNeeds& needs);

}  // namespace blem_sim::sim
