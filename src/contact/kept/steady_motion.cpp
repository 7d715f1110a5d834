#include "kept/steady_motion.h"

#include "kept/list_schedule.h"

namespace blem_sim::contact {
void SteadyMotion::add(const Pose& X, const Pose& Y, const Vector3& middle) {
  const Matrix3 turn = Y.linear() * X.linear().transpose();
  // Rotation vector of a turn by a small angle.
  const Vector3 angles = 0.5 * Vector3(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
  const double share = known_ ? ListSchedule::NEWEST : 1;
  shift_ += share * (Y * middle - X * middle - shift_);
  turn_ += share * (angles - turn_);
  known_ = true;
}

Pose SteadyMotion::after(double searches, const Pose& X, const Vector3& middle) const {
  Pose Y = X;
  const double angle = searches * turn_.norm();
  if (angle > 0) Y.linear() = Eigen::AngleAxisd(angle, turn_.normalized()) * X.linear();
  Y.translation() = X * middle + searches * shift_ - Y.linear() * middle;
  return Y;
}

}  // namespace blem_sim::contact
