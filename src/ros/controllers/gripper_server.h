// The ROS name of one gripper.
#pragma once

#include <blem_sim/GripperCommandAction.h>
#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "blem_sim/sim/gripper_controller.h"
#include "controllers/controller_server.h"
#include "controllers/goal_server.h"

namespace blem_sim::node {

/** The action `gripper_cmd` below the controller's name. A goal's max_effort cannot raise or lower the motor's limit: a warning says so. */
class GripperServer : public ControllerServer {
 public:
  /** @param robot_node in the robot's namespace */
  GripperServer(const ros::NodeHandle& robot_node, sim::GripperController controller, Refusals* refusals);

  std::vector<std::string> joints() const override { return controller_.config().joints; }
  void start() override { controller_.start(); }
  void stop() override;
  void step(double time) override;
  void restartTime() override { goals_.restartTime(); }

 private:
  using Goals = GoalServer<GripperCommandAction>;

  void onGoal(Goals::Handle goal);
  void finish(const sim::GoalOutcome& outcome);

  sim::GripperController controller_;
  Goals goals_;
};

}  // namespace blem_sim::node
