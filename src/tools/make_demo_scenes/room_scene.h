// Scene of the depth camera: a workshop floor.
#pragma once

#include <vector>

#include "depth_camera.h"

namespace blem_sim::demo {

/** A workshop floor: gently uneven, free around the origin, with boards, stones, a slope, a crate and clutter around; z up. [m] */
Scene workshopFloor();

/** The floor scanned from four sides, each view with a small registration error, as one soup of overlapping sheets full of holes. */
geometry::TriangleMesh scannedFloor(const Scene& scene);

/** The same floor as raw points of three views, fewer frames averaged. */
std::vector<Vector3> scannedFloorPoints(const Scene& scene);

}  // namespace blem_sim::demo
