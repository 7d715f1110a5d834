// Whether the common perpendicular of two edges may point out of all their faces: lanes of floats or doubles. Included by the kernels only.
#pragma once

#include "features/tolerances.h"
#include "kernels/simd.h"

namespace blem_sim::contact::kernels {
namespace {

/** Largest part of n, the product of two edges, into a face of either that may come within EDGE_CONE_SLACK while unit vectors turn by no
 * more than `turn`: n by that part of twice the product of their lengths, once for itself and once for its own length; the faces by that
 * part of n.
 * @param n2 its square @param pp_qq product of the squared lengths of the edges */
template <typename Lanes, typename Number>
inline Lanes coneBound(Lanes n2, Lanes pp_qq, Number turn) {
  constexpr Number slack = static_cast<Number>(1.001 * EDGE_CONE_SLACK);
  return (slack + turn) * squareRoot(n2) + 2 * turn * squareRoot(pp_qq);
}

/** Whether n or -n, from b to a, may be a contact's normal; which of them, is not asked. @param a, b into the faces of either edge */
template <typename V, typename Lanes>
inline auto conesMayAllow(const V& n, Lanes bound, const V (&a)[2], const V (&b)[2]) {
  const Lanes into_a0 = dot(a[0], n), into_a1 = dot(a[1], n), into_b0 = dot(b[0], n), into_b1 = dot(b[1], n);
  const Lanes most = maximum(maximum(into_b0, into_b1), -minimum(into_a0, into_a1));
  const Lanes least = minimum(minimum(into_b0, into_b1), -maximum(into_a0, into_a1));
  return (most <= bound) | (least >= -bound);
}

}  // namespace
}  // namespace blem_sim::contact::kernels
