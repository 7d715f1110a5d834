#include "free_way/rigid_turn.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr double TURN_STEP = 0.02;  // [rad] about a principal axis
constexpr int MAX_TURN_STEPS = 256;

/** A body's momentum in its principal axes, and how these have turned. */
struct TurningBody {
  Vector3 momentum;
  Quaternion turn = Quaternion::Identity();

  void turnAbout(int axis, double angle) {
    const double c = std::cos(0.5 * angle), s = std::sin(0.5 * angle), cos = c * c - s * s, sin = 2 * s * c;
    const int y = (axis + 1) % 3, z = (axis + 2) % 3;
    const double along_y = momentum[y], along_z = momentum[z];
    momentum[y] = cos * along_y + sin * along_z;
    momentum[z] = cos * along_z - sin * along_y;
    Quaternion step(c, 0, 0, 0);
    step.vec()[axis] = s;
    turn = turn * step;
  }
};

}  // namespace

// H = sum of L_i^2 / 2 I_i = L^2 / 2 I_middle plus the rest for the other two axes, each a turn about its axis. The first part is a turn
// about the momentum, which commutes with the others.
RigidTurn turnFreely(const Matrix3& inertia, const Vector3& momentum, double dt) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> principal(inertia);
  const Vector3 moments = principal.eigenvalues();
  Matrix3 axes = principal.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
  const double rate_x = 1 / moments[0] - 1 / moments[1], rate_z = 1 / moments[2] - 1 / moments[1];
  const double turns = std::ceil(dt * momentum.norm() * std::max(std::abs(rate_x), std::abs(rate_z)) / TURN_STEP);
  const int steps = turns < MAX_TURN_STEPS ? std::max(1, static_cast<int>(turns)) : MAX_TURN_STEPS;
  TurningBody body{axes.transpose() * momentum};
  const double h = dt / steps;
  for (int i = 0; i < steps; ++i) {
    body.turnAbout(0, 0.5 * h * rate_x * body.momentum[0]);
    body.turnAbout(2, h * rate_z * body.momentum[2]);
    body.turnAbout(0, 0.5 * h * rate_x * body.momentum[0]);
  }
  const Eigen::AngleAxisd about_momentum(dt * momentum.norm() / moments[1], momentum.stableNormalized());
  const Matrix3 end = about_momentum.toRotationMatrix() * axes * body.turn.normalized().toRotationMatrix();
  return {end * axes.transpose(), end * (end.transpose() * momentum).cwiseQuotient(moments)};
}

}  // namespace blem_sim::dynamics
