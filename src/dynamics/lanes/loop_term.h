// A joint that closes a loop: each forbidden direction is a bilateral row with a proximal point, its free axis a joint like any other.
#pragma once

#include "lanes/joint_term.h"
#include "lanes/spatial.h"

namespace blem_sim::dynamics {

struct LoopTerm {
  Vector3 origin;          ///< of the joint frame, in the world
  Matrix6 basis;           ///< columns: unit wrenches about the child's reference point; the free axis, if any, last
  int rows = 0;            ///< forbidden columns: 5, or 6 for a fixed joint
  Vector6 rho, target;     ///< per forbidden column: proximal weight; velocity asked for, of the child against the parent
  Vector6 previous;        ///< impulse of the proximal point
  JointTerm drive;         ///< along the free axis
  Vector6 velocity, step;  ///< along the columns, at the present iterate and along the search direction

  double impulse(int row, double v) const {
    if (row >= rows) return drive.impulse(v);
    return previous[row] + (target[row] - v) / rho[row];
  }
  double stiffness(int row, double v) const { return row >= rows ? drive.stiffness(v) : 1 / rho[row]; }

  Vector6 impulses() const {
    Vector6 g;
    for (int r = 0; r < 6; ++r) g[r] = impulse(r, velocity[r]);
    return g;
  }

  /** Largest miss [rad/s or m/s] of forbidden velocities to their targets; along the free axis, the drive's creep. */
  double creep() const {
    double worst = rows < 6 ? drive.creep(velocity[5]) : 0;
    for (int r = 0; r < rows; ++r) worst = std::max(worst, std::abs(velocity[r] - target[r]));
    return worst;
  }

  void remember() {
    for (int r = 0; r < rows; ++r) previous[r] = impulse(r, velocity[r]);
    if (rows < 6) drive.remember(velocity[5]);
  }
};

}  // namespace blem_sim::dynamics
