// Which of an element's features may have a contact with another element at all: what a few products can rule out, before the exact work.
#pragma once

#include "element_shape.h"

namespace blem_sim {

/** Of the features that an element owns. */
struct Candidates {
  int vertices, edges;  ///< bits of its corners and sides
  int inside[3];        ///< per side in `edges`: bits of the other element's corners that lie too far over its own face
};

/**
 * A contact's direction points out of every face beside its edge, but for a sine of EDGE_CONE_SLACK: what lies farther inside a side of its
 * face than that part of the range has none with the side.
 * @return bits of the corners of `other` farther than `limit` [m] inside side k of the face; 0 if the face cannot tell
 */
inline int cornersInside(const ElementShape& face, int k, const ElementShape& other, double limit) {
  if (!face.is_face || !face.is_fat) return 0;
  const double most = limit * limit * face.length2[k];
  int bits = 0;
  for (int j = 0; j < 3; ++j) {
    const double inside = insideSide(face, k, other.corners[j]);
    bits |= static_cast<int>(inside * std::abs(inside) > most) << j;
  }
  return bits;
}

/** How far beyond its end an edge's fading contact may lie, as part of the range: a fifth of it deep it has faded by then. */
constexpr double FADED = 0.1;

/** @param heights [m] of e's corners over the other's plane, null unless the other is a face @param range [m] within which contacts count
 */
inline Candidates candidatesOf(const ElementShape& e, const double* heights, const ElementShape& other, double range) {
  Candidates out{e.vertices, e.edges, {0, 0, 0}};
  for (int k = 0; heights && k < 3; ++k) {
    const double p = heights[k], q = heights[NEXT[k]];
    out.vertices &= ~(static_cast<int>(std::abs(p) > range) << k);
    out.edges &= ~(static_cast<int>((std::min(p, q) > range) | (std::max(p, q) < -range)) << k);
  }
  const double limit = (1.001 * EDGE_CONE_SLACK + FADED) * range + 10 * CLOSED;
  for (int k = 0; k < 3; ++k) {
    if (out.edges >> k & 1) out.inside[k] = cornersInside(e, k, other, limit);
    if (out.inside[k] == 7) out.edges &= ~(1 << k);
  }
  return out;
}

inline bool mayMeetCorner(const Candidates& of_e, int k, int other_corner) {
  return of_e.edges >> k & 1 && (of_e.inside[k] >> other_corner & 1) == 0;
}

/** False if both ends of the other's side lie too far inside. */
inline bool mayMeetSide(const Candidates& of_e, int k, int other_side) {
  return (of_e.inside[k] >> other_side & of_e.inside[k] >> NEXT[other_side] & 1) == 0;
}

}  // namespace blem_sim
