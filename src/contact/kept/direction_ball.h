// Directions of a surface's normals, all in one ball.
#pragma once

#include "blem_sim/geometry/types.h"

namespace blem_sim::contact {

/** Holds unit vectors, but for their signs; none at first. */
class DirectionBall {
 public:
  /** Grows so far that it holds a ball around `centre`, or around its opposite. */
  void add(Vector3 centre, double radius);
  /** Largest part [m] of v along a direction in here, or against it. */
  double most(const Vector3& v) const;

 private:
  Vector3 centre_ = Vector3::Zero();
  double radius_ = -1;  // negative: it holds nothing
};

}  // namespace blem_sim::contact
