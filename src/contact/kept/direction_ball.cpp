#include "kept/direction_ball.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::contact {

void DirectionBall::add(Vector3 centre, double radius) {
  if (centre.dot(centre_) < 0) centre = -centre;
  const Vector3 away = centre - centre_;
  const double distance = away.norm();
  if (distance + radius <= radius_) return;
  if (radius_ < 0 || distance + radius_ <= radius) {
    centre_ = centre;
    radius_ = radius;
    return;
  }
  const double wider = 0.5 * (distance + radius + radius_);
  centre_ += (wider - radius_) / distance * away;
  radius_ = wider;
}

double DirectionBall::most(const Vector3& v) const {
  if (radius_ < 0) return 0;
  const double length = v.norm();
  return std::min(length, std::abs(centre_.dot(v)) + radius_ * length);
}

}  // namespace blem_sim::contact
