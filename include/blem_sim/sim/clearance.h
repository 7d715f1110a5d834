// How near the links of a robot come to each other and to everything else, in poses that need not be those at hand.
#pragma once

#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/contact/broad_phase.h"
#include "blem_sim/contact/narrow_phase.h"
#include "blem_sim/sim/simulator.h"

namespace blem_sim::sim {

/** Two colliders near each other, at the place where they are nearest. */
struct Approach {
  int a = -1, b = -1;                                                           ///< indices of the colliders, a of the robot
  double gap = std::numeric_limits<double>::quiet_NaN();                        ///< [m] between their layers; below 0 these overlap
  bool crossed = false;                                                         ///< bare meshes cross: gap is then a way back, and rough
  Vector3 point = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< [m] world, in the middle between them
  Vector3 normal_BA = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< unit, world: the way of A out
};

/**
 * Colliders of a simulation as they are when this is made, for questions about one robot in other poses. Everything else stands where it
 * stood then. Links that a joint joins, that the configuration keeps from touching (disable_collisions), or that crossed each other then,
 * are never told of, whether the robot touches itself in the simulation or not. A link that is wholly inside a mesh is near nothing.
 */
class RobotClearance {
 public:
  RobotClearance(const Simulator& simulator, int robot);

  const std::vector<std::string>& links() const { return links_; }      ///< of the robot, in the order of poses
  const std::vector<std::string>& colliders() const { return names_; }  ///< "model::link", by index
  /**
   * Pairs with a gap below a distance [m], none twice, sorted by their colliders.
   * @param X_WL pose of every link of the robot in the world
   */
  std::vector<Approach> find(const std::vector<Pose>& X_WL, double distance);

 private:
  void leaveOutNeighbours(const RobotInfo& robot);
  void leaveOutListed(const Simulator& simulator, const RobotInfo& robot);
  void leaveOutCrossing();
  bool isOwn(int collider) const { return colliders_[static_cast<std::size_t>(collider)].model == model_; }

  int model_;
  std::vector<std::string> links_, names_;
  std::vector<contact::Collider> colliders_;
  std::vector<Pose> X_LC_;                       // of the robot's colliders, in their links
  std::vector<contact::ColliderMotion> motion_;  // of all, where they stand
  contact::CollisionFilter filter_;
  std::set<std::pair<int, int>> left_out_;  // (smaller, larger) index of the robot's own
  contact::BroadPhase broad_phase_;
  contact::NarrowPhaseWorkspace workspace_;
};

}  // namespace blem_sim::sim
