// Polygons as triangles.
#pragma once

#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim::model {

/**
 * Splits a polygon, perhaps concave, nearly plane, by cutting ears; n - 2 triangles with its winding. One that crosses itself or has a
 * coordinate that is not finite is split as a fan. [Meisters 1975, Polygons Have Ears]
 * @param polygon at least three corners as indices into vertices
 */
std::vector<Vector3i> splitPolygon(const std::vector<Vector3>& vertices, const std::vector<int>& polygon);

}  // namespace blem_sim::model
