// What of a leaf lies where another one can have a contact with it. Included by the kernels only.
#pragma once

#include "leaf_lanes.h"

namespace blem_sim::kernels {
namespace {

/** Coordinates along the axes of a region [m]. */
inline FloatVectors alongAxes(const LeafRegion& region, const FloatVectors& v) {
  const auto along = [&v](const float(&axis)[3]) { return axis[0] * v.x + axis[1] * v.y + axis[2] * v.z; };
  return {along(region.axes[0]), along(region.axes[1]), along(region.axes[2])};
}

/** How far outside the box, along each axis [m]. */
inline FloatVectors outsideOf(const LeafRegion& region, const FloatVectors& p) {
  const auto outside = [&](Floats at, int k) { return absolute(at - region.middle[k]) - region.halves[k]; };
  return {outside(p.x, 0), outside(p.y, 1), outside(p.z, 2)};
}

/** Vertices of a that may have a contact with a vertex, edge or face of b as those allow it. */
inline std::uint32_t verticesNear(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach) {
  const LeafRegion& region = b.region;
  const float most = region.beside * reach.range + (1 + region.fall) * reach.margin;
  return bitsWhere(a.vertex_count, [&](std::uint32_t i) {
    const FloatVectors outside = outsideOf(region, alongAxes(region, severalVertices(a, i)));
    const Floats beside = most - region.fall * maximum(outside.z, Floats{});
    return maximum(maximum(outside.x, outside.y) - beside, outside.z - reach.range) <= 0;
  });
}

/** How far edges lie outside the box, along each axis [m]. */
inline FloatVectors outsideOf(const LeafRegion& region, const LeafEdges& edges, std::uint32_t first) {
  const FloatVectors half = 0.5f * row(&edges.lengths[first]) * FloatVectors::several(edges.directions, first);
  const FloatVectors middle = outsideOf(region, alongAxes(region, FloatVectors::several(edges.starts, first) + half)),
                     along = alongAxes(region, half);
  return {middle.x - absolute(along.x), middle.y - absolute(along.y), middle.z - absolute(along.z)};
}

/** Edges of a that may have a contact with an edge of b. */
inline std::uint32_t edgesNear(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach) {
  const float most = b.region.edge_beside * reach.range + reach.margin;
  return edgesWhere(a, [&](const LeafEdges& edges, std::uint32_t i) {
    const FloatVectors outside = outsideOf(b.region, edges, i);
    // Feet that leave both edges lie the more beside each other the less they lie above.
    const Floats beside = minimum(most - maximum(outside.z, Floats{}), allFloats(reach.range)) + reach.margin;
    return maximum(maximum(outside.x, outside.y) - beside, outside.z - reach.range) <= 0;
  });
}

/** Edges of a that come within the margin of b's box. */
inline std::uint32_t edgesAtBox(const LeafShapes& a, const LeafShapes& b, float margin) {
  return edgesWhere(a, [&](const LeafEdges& edges, std::uint32_t i) {
    const FloatVectors outside = outsideOf(b.region, edges, i);
    return maximum(maximum(outside.x, outside.y), outside.z) <= margin;
  });
}

}  // namespace
}  // namespace blem_sim::kernels
