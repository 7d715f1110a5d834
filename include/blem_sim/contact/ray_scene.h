// The colliders of a world as rays meet them.
#pragma once

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

/** First hits of rays with many targets, by a tree over their boxes. Any number of threads may ask at a time. */
class RayScene {
 public:
  explicit RayScene(std::vector<RayTarget> targets);

  /** A ray's range, which may begin later for one model: a sensor sees through what is too near on its own robot. */
  struct Query {
    double farthest = std::numeric_limits<double>::infinity();
    int own_model = -1;
    double own_nearest = 0;
  };
  struct Hit {
    double t = std::numeric_limits<double>::infinity();  ///< in units of the ray's direction
    int target = -1;                                     ///< -1: no hit
  };
  /** @param ray in the world @return first hit, the smaller target of several */
  Hit firstHit(const geometry::Ray& ray, const Query& query) const;

 private:
  double hit(int target, const geometry::Ray& ray, const geometry::RayRange& range) const;
  void add(int target, const geometry::Ray& ray, const Query& query, Hit* first) const;

  std::vector<RayTarget> targets_;
  std::vector<Pose> X_CW_;      // of each target
  std::vector<int> unbounded_;  // half-spaces
  std::vector<int> bounded_;    // the others, in the order of the tree's elements
  geometry::Bvh boxes_;         // over diagonals of the world's boxes of the bounded ones
};

}  // namespace blem_sim::contact
