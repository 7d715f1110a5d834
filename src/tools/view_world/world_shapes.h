// Colliders of a world as shapes to draw.
#pragma once

#include <vector>

#include "drawn_shape.h"
#include "world_frames.h"

namespace blem_sim {

/**
 * Robots, objects and environments as contact has them: triangles; rods and balls of their radius; clouds coloured by height, their points
 * as balls or, beyond 20,000, as dots; half-spaces as chequered squares about what the camera looks at, of cells of a power of ten [m].
 * @param layers boundary layers too, as translucent shells
 */
std::vector<DrawnShape> worldShapes(const sim::Simulator& simulator, const ViewCamera& camera, bool layers);

/** Box around everything that moves, in all frames; around all environments but half-spaces if nothing does; else a cube of 1 m. */
Box worldBox(const sim::Simulator& simulator, const std::vector<WorldFrame>& frames);

/** Contacts as balls, their forces as arrows. @param scale [m]: the weight of all that moves is an arrow of this length */
DrawnShape contactShape(const sim::Simulator& simulator, const std::vector<sim::ContactReport>& contacts, double scale);

}  // namespace blem_sim
