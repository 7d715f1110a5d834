// The colliders of a world as rays meet them.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/geometry/ray_cast.h"

namespace blem_sim::contact {

/** A collider where it stands. Holds its geometry, whatever becomes of the collider. */
struct RayTarget {
  std::shared_ptr<const CollisionGeometry> geometry;
  Pose X_WC = Pose::Identity();  ///< geometry in the world
  double radius = 0;             ///< [m] of points and segments; triangles and half-spaces are met bare
  int model = -1;                ///< it belongs to
};

/** Rays from one point, side by side: they are followed together, at a fraction of the cost if they lie close together. */
struct RayFan {
  static constexpr int WIDTH = 8;
  Vector3 origin;                         ///< [m] any frame
  std::array<Vector3, WIDTH> directions;  ///< lengths along a ray are in units of its own
};

/** First hits of rays with many targets, by a tree over their boxes. Any number of threads may ask at a time. */
class RayScene {
 public:
  explicit RayScene(std::vector<RayTarget> targets);

  /** A ray's range, which may begin later for one model: a sensor sees through what is too near on its own robot. */
  struct Query {
    double farthest = std::numeric_limits<double>::infinity();
    int own_model = -1;
    double own_nearest = 0;

    /** Place along a ray from which a model counts. */
    double nearestOf(int model) const { return model == own_model && own_model >= 0 ? own_nearest : 0; }
  };
  struct Hit {
    double t = std::numeric_limits<double>::infinity();  ///< in units of the ray's direction
    int target = -1;                                     ///< -1: no hit
  };
  using Hits = std::array<Hit, RayFan::WIDTH>;
  /** @param fan in the world @return first hit of each ray, the smaller target of several; its neighbours change no bit of it */
  Hits firstHits(const RayFan& fan, const Query& query) const;

 private:
  class Search;

  std::vector<RayTarget> targets_;
  std::vector<Pose> X_CW_;      // of each target
  std::vector<int> unbounded_;  // half-spaces
  std::vector<int> bounded_;    // the others, in the order of the tree's elements
  geometry::Bvh boxes_;         // over diagonals of the world's boxes of the bounded ones
};

}  // namespace blem_sim::contact
