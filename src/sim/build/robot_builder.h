// One robot's bodies, joints, motors, colliders and sensors into a world.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/contact/narrow_phase.h"
#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"
#include "build/simulated_world.h"
#include "build/surface_library.h"
#include "gazebo/gazebo_robot.h"

namespace blem_sim::sim {

/** Root link of a URDF that is the frame of the world on /tf; a robot that is spawned with it is fixed. */
inline constexpr const char* WORLD_LINK = "world";

/** Lives while one robot is added. */
class RobotBuilder {
 public:
  /** Checks everything that can be wrong. @throws InputError */
  RobotBuilder(const RobotConfig& config, const ContactConfig& contact, const std::shared_ptr<const model::RobotModel>& model);

  void addTo(SimulatedWorld* world, SurfaceLibrary* surfaces);

 private:
  RobotBuilder(const GazeboRobot& robot, const ContactConfig& contact, std::shared_ptr<const model::RobotModel> model);
  void placeBodies();
  double initialPosition(const model::LumpedJoint& joint) const;
  void addBodies();
  void addJoints();
  void addJoint(int joint, const MotorSettings& motor);
  void addColliders(SurfaceLibrary* surfaces);
  void disableNeighbours();
  void disableBodies(int lumped_a, int lumped_b);
  void disableListedPairs();
  // robot_start.cpp
  /** Links that start within each other's layers: what crosses or is caught never touches, layers of the others are narrowed. */
  void partAtStart();
  contact::ContactManifold meetingAtStart(const contact::Collider& a, const contact::Collider& b,
                                          contact::NarrowPhaseWorkspace* workspace) const;
  void separate(const std::vector<std::pair<int, int>>& pairs);
  void narrowLayers(const std::vector<double>& shares);
  std::string linkOf(const contact::Collider& collider) const { return model_->links[collider.link].name; }
  void nameFrames();
  /** Leaves topics to the odometry of drives. */
  void yieldToDrives();
  /** Notes on a root link of the name that the frame of the world has. */
  void tellOfWorldLink();
  void setSelfCollision();
  void addSensors(int robot);
  /** Says where the axes of a wrench and their origin are. */
  void placeWrench(SensorConfig* sensor) const;
  void checkFrame(const SensorConfig& sensor);
  /** Notes a line, which begins with the robot's name, once. */
  void note(const std::string& words);

  const RobotConfig config_;
  const ContactConfig contact_;
  std::shared_ptr<const model::RobotModel> model_;
  std::shared_ptr<const model::LumpedRobot> lumped_;
  std::vector<double> positions_;  ///< of lumped joints, at the start
  std::vector<Pose> X_WB_;         ///< of lumped bodies, at the start
  std::vector<std::string> start_notes_;
  /** A collider of the robot. */
  struct OwnCollider {
    int collider;
    double layer;  ///< [m] that may be narrowed; 0: its radius is part of its shape
  };

  SimulatedWorld* world_ = nullptr;
  RobotInfo info_;
  std::vector<OwnCollider> own_;  ///< in the order of the load report
};

}  // namespace blem_sim::sim
