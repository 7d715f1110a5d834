// One robot's bodies, joints, motors, colliders and sensors into a world.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "blem_sim/contact/narrow_phase.h"
#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"
#include "build/simulated_world.h"
#include "build/surface_library.h"
#include "gazebo/gazebo_robot.h"

namespace blem_sim::sim {

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
  void disableCrossings();
  bool crossAtStart(const contact::Collider& a, const contact::Collider& b, contact::NarrowPhaseWorkspace* workspace) const;
  void nameFrames();
  void setSelfCollision();
  void addSensors(int robot);
  /** Says where the axes of a wrench and their origin are. */
  void placeWrench(SensorConfig* sensor) const;
  void checkFrame(const SensorConfig& sensor);
  void note(const std::string& words) { world_->notes.push_back(config_.name + ": " + words); }

  const RobotConfig config_;
  const ContactConfig contact_;
  std::shared_ptr<const model::RobotModel> model_;
  std::shared_ptr<const model::LumpedRobot> lumped_;
  std::vector<double> positions_;  ///< of lumped joints, at the start
  std::vector<Pose> X_WB_;         ///< of lumped bodies, at the start
  std::vector<std::string> start_notes_;
  SimulatedWorld* world_ = nullptr;
  RobotInfo info_;
};

}  // namespace blem_sim::sim
