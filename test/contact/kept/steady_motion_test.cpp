// Poses that a mesh on its way is expected to reach.
#include "kept/steady_motion.h"

#include <gtest/gtest.h>

namespace blem_sim::contact {
namespace {

const Vector3 MIDDLE(0.1, -0.2, 0.3);  // of the mesh [m]

/** The pose so many steps on, of a mesh whose middle moves by `shift` while it turns about it by `turn` in every step. */
Pose steadyPose(int step, const Vector3& shift, const Vector3& turn) {
  Pose X = Pose::Identity();
  const double angle = step * turn.norm();
  if (angle > 0) X.linear() = Eigen::AngleAxisd(angle, turn.normalized()).toRotationMatrix();
  X.translation() = MIDDLE + step * shift - X.linear() * MIDDLE;
  return X;
}

double distance(const Pose& X, const Pose& Y) { return (X.matrix() - Y.matrix()).cwiseAbs().maxCoeff(); }

TEST(SteadyMotion, GoesOnAsItWent) {
  const Vector3 shift(1e-4, 2e-4, -1e-4), turn(1e-3, -2e-3, 5e-4);
  SteadyMotion motion;
  for (int step = 0; step < 5; ++step) motion.add(steadyPose(step, shift, turn), steadyPose(step + 1, shift, turn), MIDDLE);
  EXPECT_LT(distance(motion.after(12, steadyPose(5, shift, turn), MIDDLE), steadyPose(17, shift, turn)), 1e-7);
}

TEST(SteadyMotion, TremblingGoesNowhere) {
  const Vector3 shift(1e-4, 0, 0), turn(0, 1e-3, 0);
  const Pose X = Pose::Identity(), Y = steadyPose(1, shift, turn);
  SteadyMotion motion;
  for (int i = 0; i < 50; ++i) {
    motion.add(X, Y, MIDDLE);
    motion.add(Y, X, MIDDLE);
  }
  EXPECT_LT(distance(motion.after(10, X, MIDDLE), X), 0.2 * 10 * distance(X, Y));
}

TEST(SteadyMotion, StaysWhereNothingIsKnown) {
  EXPECT_EQ(distance(SteadyMotion().after(10, Pose::Identity(), MIDDLE), Pose::Identity()), 0);
}

}  // namespace
}  // namespace blem_sim::contact
