// Ways of jointed bodies through a solve, if joints go on as they do: links of a tree move on bent paths.
#pragma once

#include <vector>

#include "contacts/motion/body_twist.h"

namespace blem_sim::sim {

class BodyWays {
 public:
  /** Takes the state at hand. @param bodies its states, by slot; read until the next start @param dt [s] of the solve */
  void start(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, double dt);
  /**
   * Makes a link's way the screw that leads it from its pose to that at the end of the solve, while every joint of its tree keeps its
   * velocity and the root its own: exact there, and all along on one hinge of the world. A body on no joint keeps the way it has.
   * @param way of the body from its start on
   */
  void lead(int body, BodyTwist* way) const;
  /** Makes a link's way the screw that leads it to a pose at the end of the solve. A body on no joint keeps the way it has. */
  void leadTo(int body, const Pose& X_WB, BodyTwist* way) const;
  /**
   * Speed [m/s] by which links of a tree swing each other within the solve, beside turning: what a body of the tree's size would give its
   * ends if it turned as fast as the fastest link. The spin of a rotor that is balanced about its joint's axis, and carries nothing, swings
   * none. 0 for a body on no joint.
   */
  double swing(int body) const { return body == dynamics::WORLD_BODY ? 0 : swings_[body]; }

 private:
  bool isOnJoint(int body) const;
  void findParents();
  void findRotors(const RobotInfo& robot);
  double turnOf(int body) const;
  double swingOf(const ModelInfo& model) const;
  Pose ahead(int body) const;
  BodyTwist twist(int body) const;

  const SimulatedWorld* world_ = nullptr;
  const std::vector<dynamics::BodyState>* bodies_ = nullptr;
  double dt_ = 0;
  std::vector<int> parents_;     // by body
  std::vector<double> swings_;   // by body
  std::vector<Vector3> rotors_;  // by body: axis, in its frame, of what is balanced about its joint's and carries nothing; else zero
};

}  // namespace blem_sim::sim
