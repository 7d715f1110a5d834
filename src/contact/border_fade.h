// A vertex that has left a plane over its border, where nothing takes the contact over: it fades instead of vanishing.
#pragma once

#include "edge_pair.h"
#include "element_shape.h"
#include "mesh_pair.h"

namespace blem_sim {

/** Depth lost per distance outside: a contact of depth p is gone p / FADE_SLOPE beyond the border. */
constexpr double FADE_SLOPE = 2;

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
