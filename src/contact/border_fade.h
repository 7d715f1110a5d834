// A vertex that has left a plane over its border, where nothing takes the contact over: it fades instead of vanishing.
#pragma once

#include "edge_pair.h"
#include "element_shape.h"
#include "mesh_pair.h"

namespace blem_sim {

/** Depth lost per distance outside: a contact of depth p is gone p / FADE_SLOPE beyond the border. */
constexpr double FADE_SLOPE = 4;

/** The part of its depth that an edge-edge contact has lost whose normal points into a face beside an edge by `slope` (sine). */
inline double coneFade(double slope) { return std::min(std::max(2 * slope / EDGE_CONE_SLACK - 1, 0.0), 1.0); }

/** The part of the fade over a border that applies where a surface rises by `jump` (sine) towards the other mesh beside the feature that
 * is left, or the contact that takes over is so much of the distance away. One that is nearer than half of EDGE_CONE_SLACK takes over
 * without loss, and none fades beside it; the ramp above is short, since a part fades the faster. */
inline double borderFade(double jump) {
  constexpr double RAMP = 0.1 * EDGE_CONE_SLACK;
  return std::min(std::max((jump - 0.5 * EDGE_CONE_SLACK) / RAMP, 0.0), 1.0);
}

struct BorderFade {
  Vector3 foot;  ///< closest point of the face, on its plane's border; frame F
  double lost;   ///< [m] of depth
};

/**
 * Over a border that is convex an exact successor is there (vertex-edge, edge-edge) unless the vertex's own surface comes closer to the
 * plane away from it; over a concave border there is none.
 * @param p the vertex in frame F @param height of p over the face's plane, by its normal
 * @return false if p projects into the plane, has a successor, or has lost more than `most` [m]
 */
bool fadeOverBorder(const MeshPair& pair, bool vertex_moves, int vertex, const Vector3& p, double height, const ElementShape& face,
                    double most, BorderFade* out);

}  // namespace blem_sim
