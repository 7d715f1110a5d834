#pragma once

#include <blem_sim/ListControllerTypes.h>
#include <blem_sim/ListControllers.h>
#include <blem_sim/LoadController.h>
#include <blem_sim/SwitchController.h>
#include <blem_sim/UnloadController.h>
#include <ros/node_handle.h>

#include "controllers/robot_controllers.h"

namespace blem_sim::node {

/**
 * `controller_manager/{list_controllers,list_controller_types,load_controller,unload_controller,switch_controller}` in a robot's namespace:
 * what a spawner asks for. What cannot be done is answered with ok = false and told in one error line.
 */
class ControllerServices {
 public:
  explicit ControllerServices(RobotControllers* controllers);

 private:
  bool onList(ListControllers::Request& request, ListControllers::Response& response);
  bool onListTypes(ListControllerTypes::Request& request, ListControllerTypes::Response& response);
  bool onLoad(LoadController::Request& request, LoadController::Response& response);
  bool onUnload(UnloadController::Request& request, UnloadController::Response& response);
  bool onSwitch(SwitchController::Request& request, SwitchController::Response& response);

  RobotControllers* controllers_;
  ros::NodeHandle node_;
  ros::ServiceServer list_, list_types_, load_, unload_, switch_;
};

}  // namespace blem_sim::node
