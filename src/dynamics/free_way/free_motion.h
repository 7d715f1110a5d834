// Way of a tree through a step under its own momentum alone: fast trees follow it instead of a straight one.
#pragma once

#include "free_way/articulated_bodies.h"

namespace blem_sim::dynamics {

/** A tree at the start of a step, and the velocities of all dofs with which it sets out. */
struct FreeStart {
  const Forest& forest;
  int tree;
  double dt;
  const ForestMotion& motion;
  const Eigen::VectorXd& velocity;
};

/** Quality of a free motion that was followed. */
struct FreeMotionReport {
  double miss = 0;       ///< of kinetic energy, relative, before it was put right
  bool followed = true;  ///< with as many sub-steps as are allowed at most; if not, energy is lost
  int evaluations = 0;   ///< of a tree's accelerations
};

/**
 * Geodesic motion of trees: joints turn as they may, nothing acts from outside. Kinetic energy and a free tree's momenta are kept to
 * rounding. Held dofs keep their velocities and supply the impulses for it; mimic joints follow their masters. A tree of several dofs is
 * followed by sub-steps of Runge and Kutta's fourth order, twice as many as long as energy is missed; a rigid body by turns about its
 * principal axes [McLachlan 1993], which are symplectic. Bounded, allocates nothing.
 */
class FreeMotion {
 public:
  void resize(const Forest& forest);

  /** Per dof: whether it keeps its velocity on the way. To be set before `follow`, which lets go of those that cannot. */
  std::vector<char>& held() { return bodies_.held; }
  const std::vector<char>& held() const { return bodies_.held; }
  /** Per dof [N m s or N s]: least and largest impulse that it can supply to do so, with those that follow it. */
  std::vector<double> least, most;

  /** Follows a tree from its present poses. @param mass_velocity M times the velocity at the start */
  FreeMotionReport follow(const FreeStart& start, const Eigen::VectorXd& mass_velocity);

  /** Takes the end of the way: positions, velocities of the dofs, owed impulses, a free root's pose. Then placeBodies, computeInertias. */
  void takeEnd(const Forest& forest, int tree, ForestMotion* motion) const;

  /** Rate of change of a node's momentum on the way, at the middle of its centre of mass's, about the reference at the start.
   *  @param motion at the start @param set_out twist with which the node sets out */
  Vector6 momentumRate(const Forest& forest, int node, double dt, const ForestMotion& motion, const Vector6& set_out) const;
  /** Origin of a node's joint at the middle of the step, in the world. */
  Vector3 middleJoint(int node, const ForestMotion& motion) const;

 private:
  struct RootPose {
    Eigen::Vector4d turn;  ///< quaternion's coefficients
    Vector3 origin;
  };
  void place(const Forest& forest, int tree, const RootPose& root);
  void subStep(const Forest& forest, int tree, double dt, RootPose* root);
  void run(const FreeStart& start, int steps);
  double energy(const Forest& forest, int tree) const;
  double work(const Forest& forest, int tree) const;
  bool letGo(const Forest& forest, int tree);
  void correct(const Forest& forest, int tree, double energy_wanted);
  void leaveFrame(const FreeStart& start);
  Matrix3 turnRigid(const FreeStart& start);
  void setOut(const FreeStart& start);
  void wait(const FreeStart& start);
  int firstSteps(const Forest& forest, int tree, double dt) const;

  ForestMotion at_;  ///< at the instant at hand; the reference is that of the step's start, a free tree's centre of mass stands still
  ArticulatedBodies bodies_;
  // Per dof.
  std::vector<double> start_position_;
  Eigen::VectorXd start_velocity_, sum_position_, sum_velocity_, sum_effort_, owed_, supplied_;
  // Per tree.
  std::vector<Vector3> drift_;  ///< [m/s] of a free tree's centre of mass
  std::vector<Vector3> spin_;   ///< [kg m^2/s] of a free tree about it
};

}  // namespace blem_sim::dynamics
