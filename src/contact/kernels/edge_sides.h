// Whether a vertex is where it can have a contact with an edge: lanes of floats or doubles. Included by the kernels only.
#pragma once

#include "features/tolerances.h"
#include "kernels/simd.h"

namespace blem_sim::contact::kernels {
namespace {

/** A vertex as an edge sees it, in metres. */
template <typename Lanes>
struct AtEdge {
  Lanes inside[2];  ///< along the directions into the edge's faces
  Lanes distance;   ///< from the edge's line
  Lanes beyond;     ///< beyond the edge's ends
};

/** Lengths [m] within which vertices matter to edges. */
template <typename Number>
struct EdgeReach {
  Number range;     ///< of distance, and the margin
  Number margin;    ///< that the vertex may move
  Number rounding;  ///< that AtEdge::inside may be wrong by
};

/** Whether a vertex that is over neither of the edge's faces is not behind both, within range, and no farther beyond an end than a contact
 * fades: it does so at round edges.
 * @param fold length of the sum of the directions into the faces @param round whether the edge is */
template <typename Lanes, typename Bits, typename Number>
inline auto isAtEdge(const AtEdge<Lanes>& vertex, Lanes fold, Bits round, const EdgeReach<Number>& reach) {
  const Number slack = static_cast<Number>(2 * CONE_SLACK) * reach.range + reach.rounding;
  const Lanes most = reach.range - vertex.distance, fades = round ? most / static_cast<Number>(FADE_SLOPE) : Lanes{};
  return (vertex.inside[0] + vertex.inside[1] <= fold * reach.margin + 2 * slack) & (most >= 0) & (vertex.beyond <= fades + reach.margin);
}

}  // namespace
}  // namespace blem_sim::contact::kernels
