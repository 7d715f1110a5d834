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

/** Whether a vertex that is over neither of the edge's faces is not behind both, within range, and no farther beyond an end than a contact
 * fades: it does so at round edges.
 * @param fold length of the sum of the directions into the faces @param round whether the edge is @param range [m] of distance, and the
 * margin @param margin [m] that the vertex may move @param rounding [m] that `inside` may be wrong by */
template <typename Lanes, typename Bits, typename Number>
inline auto isAtEdge(const AtEdge<Lanes>& vertex, Lanes fold, Bits round, Number range, Number margin, Number rounding) {
  const Number slack = static_cast<Number>(2 * CONE_SLACK) * range + rounding;
  const Lanes most = range - vertex.distance, fades = round ? most / static_cast<Number>(FADE_SLOPE) : Lanes{};
  return (vertex.inside[0] + vertex.inside[1] <= fold * margin + 2 * slack) & (most >= 0) & (vertex.beyond <= fades + margin);
}

}  // namespace
}  // namespace blem_sim::contact::kernels
