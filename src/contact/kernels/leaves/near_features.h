// Features of a leaf that lie where another leaf can have a contact with them. Included by the kernels only.
#pragma once

#include "kernels/leaves/leaf_lanes.h"

namespace blem_sim::contact::kernels {
namespace {

/** Coordinates along the axes of a region [m]. */
inline FloatVectors alongAxes(const LeafRegion& region, const FloatVectors& v) {
  const auto along = [&v](const float(&axis)[3]) { return axis[0] * v.x + axis[1] * v.y + axis[2] * v.z; };
  return {along(region.axes[0]), along(region.axes[1]), along(region.axes[2])};
}

/** Distance [m] of points outside the box along each axis; negative inside. */
inline FloatVectors outsideOf(const LeafRegion& region, const FloatVectors& p) {
  const auto outside = [&](Floats at, int k) { return absolute(at - region.middle[k]) - region.halves[k]; };
  return {outside(p.x, 0), outside(p.y, 1), outside(p.z, 2)};
}

/** Vertices of a that may have a contact with a vertex, edge or face of b as those allow it. */
inline std::uint32_t verticesNear(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach) {
  const LeafRegion& region = b.region;
  const float most = (region.lean + region.fall) * reach.range + (1 + region.fall) * reach.margin;
  return bitsWhere(a.vertex_count, [&](std::uint32_t i) {
    const FloatVectors outside = outsideOf(region, alongAxes(region, severalVertices(a, i)));
    const Floats beside = most - region.fall * maximum(outside.z, Floats{});
    return maximum(maximum(outside.x, outside.y) - beside, outside.z - reach.range) <= 0;
  });
}

/** Edges by their middles and the ways [m] from there to their second ends. */
struct FloatSegments {
  FloatSegments(const LeafEdges& edges, std::uint32_t first)
      : half(0.5f * row(&edges.lengths[first]) * severalVectors(edges.directions, first)),
        middle(severalVectors(edges.starts, first) + half) {}
  FloatVectors half, middle;
};

/** Whether the boxes of edges come within `reach` [m] of the leaf's. */
inline FloatMask areNear(const LeafShapes& leaf, const FloatSegments& edges, float reach) {
  const auto outside = [&](Floats middle, Floats half, int k) {
    return absolute(middle - leaf.middle[k]) - absolute(half) - leaf.halves[k];
  };
  return maximum(maximum(outside(edges.middle.x, edges.half.x, 0), outside(edges.middle.y, edges.half.y, 1)),
                 outside(edges.middle.z, edges.half.z, 2)) <= reach;
}

/** Distance [m] of edges outside the box along each axis; negative inside. */
inline FloatVectors outsideOf(const LeafRegion& region, const FloatSegments& edges) {
  const FloatVectors middle = outsideOf(region, alongAxes(region, edges.middle)), along = alongAxes(region, edges.half);
  return {middle.x - absolute(along.x), middle.y - absolute(along.y), middle.z - absolute(along.z)};
}

/** Edges of a that come within `reach` [m] of b's box, and for whose distances outside along the axes of its region the test holds. */
template <typename Test>
inline std::uint32_t edgesNear(const LeafShapes& a, const LeafShapes& b, float reach, Test&& test) {
  return edgesWhere(a, [&](const LeafEdges& block, std::uint32_t i) {
    const FloatSegments edges(block, i);
    const FloatMask near = areNear(b, edges, reach);
    return bitsOf(near) == 0 ? near : near & test(outsideOf(b.region, edges));
  });
}

/** Edges of a that may have a contact with an edge of b. */
inline std::uint32_t edgesNear(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach) {
  const float most = b.region.edge_beside * reach.range + reach.margin;
  return edgesNear(a, b, reach.range, [&](const FloatVectors& outside) {
    // Feet that leave both edges lie the more beside each other the less they lie above.
    const Floats beside = minimum(most - maximum(outside.z, Floats{}), allFloats(reach.range)) + reach.margin;
    return maximum(maximum(outside.x, outside.y) - beside, outside.z - reach.range) <= 0;
  });
}

/** Largest motion [m] of points along a unit vector, or several, with room for rounding. */
template <typename Number>
inline Number motionAlong(const LeafReach& reach, Number x, Number y, Number z) {
  Number along = reach.rounding - Number{};
  for (const float(&way)[3] : reach.ways) {
    const Number part = way[0] * x + way[1] * y + way[2] * z;
    along += part < 0 ? -part : part;
  }
  return along;
}
inline Floats motionAlong(const LeafReach& reach, const FloatVectors& v) { return motionAlong(reach, v.x, v.y, v.z); }

/** Edges of a that come within the margin of b's box. */
inline std::uint32_t edgesAtBox(const LeafShapes& a, const LeafShapes& b, const LeafReach& reach) {
  const auto along = [&](const float(&axis)[3]) { return motionAlong(reach, axis[0], axis[1], axis[2]); };
  const float x = along(b.region.axes[0]), y = along(b.region.axes[1]), z = along(b.region.axes[2]);
  return edgesNear(a, b, reach.margin,
                   [&](const FloatVectors& outside) { return maximum(maximum(outside.x - x, outside.y - y), outside.z - z) <= 0; });
}

}  // namespace
}  // namespace blem_sim::contact::kernels
