#include "controllers/controller_services.h"

#include <ros/console.h>

#include "blem_sim/geometry/input_error.h"
#include "loop/checked_transport.h"

namespace blem_sim::node {

namespace {

/** True if an action that may refuse its input was done; tells why not. */
template <typename Act>
bool done(const std::string& service, const Act& act) {
  try {
    act();
    return true;
  } catch (const InputError& error) {
    ROS_ERROR("%s: %s", service.c_str(), error.what());
    return false;
  }
}

}  // namespace

ControllerServices::ControllerServices(RobotControllers* controllers)
    : controllers_(controllers),
      node_(controllers->node(), "controller_manager"),
      list_(node_.advertiseService("list_controllers", &ControllerServices::onList, this)),
      list_types_(node_.advertiseService("list_controller_types", &ControllerServices::onListTypes, this)),
      load_(node_.advertiseService("load_controller", &ControllerServices::onLoad, this)),
      unload_(node_.advertiseService("unload_controller", &ControllerServices::onUnload, this)),
      switch_(advertiseChecked<SwitchController>(node_, "switch_controller",
                                                 [this](auto& request, auto& response) { return onSwitch(request, response); })) {}

bool ControllerServices::onList(ListControllers::Request&, ListControllers::Response& response) {
  response.controller = controllers_->list();
  return true;
}

bool ControllerServices::onListTypes(ListControllerTypes::Request&, ListControllerTypes::Response& response) {
  response.types = RobotControllers::types();
  response.base_classes.assign(response.types.size(), "controller_interface::ControllerBase");
  return true;
}

bool ControllerServices::onLoad(LoadController::Request& request, LoadController::Response& response) {
  response.ok = done(load_.getService(), [&] { controllers_->load(request.name); });
  return true;
}

bool ControllerServices::onUnload(UnloadController::Request& request, UnloadController::Response& response) {
  response.ok = done(unload_.getService(), [&] { controllers_->unload(request.name); });
  return true;
}

bool ControllerServices::onSwitch(SwitchController::Request& request, SwitchController::Response& response) {
  const ControllerChange change{request.start_controllers, request.stop_controllers,
                                request.strictness != SwitchController::Request::BEST_EFFORT};
  response.ok = done(switch_.getService(), [&] {
    for (const std::string& undone : controllers_->change(change)) ROS_WARN("%s: %s", switch_.getService().c_str(), undone.c_str());
  });
  return true;
}

}  // namespace blem_sim::node
