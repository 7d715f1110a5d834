#include "controllers/robot_controllers.h"

#include <ros/console.h>
#include <ros/names.h>

#include <algorithm>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "controllers/controller_parameters.h"

namespace blem_sim {

namespace {

const char* const JOINT_STATES = "joint_state_controller/JointStateController";
const char* const DEFAULT_TYPE = "position_controllers/JointTrajectoryController";

/** Built-in types and the interface of ros_control that each stands for. */
struct TypeRow {
  const char* type;
  const char* hardware_interface;
};
const std::vector<TypeRow> TYPE_TABLE = {
    {DEFAULT_TYPE, "hardware_interface::PositionJointInterface"},
    {"velocity_controllers/JointTrajectoryController", "hardware_interface::VelocityJointInterface"},
    {"effort_controllers/JointTrajectoryController", "hardware_interface::EffortJointInterface"},
    {"pos_vel_controllers/JointTrajectoryController", "hardware_interface::PosVelJointInterface"},
    {"pos_vel_acc_controllers/JointTrajectoryController", "hardware_interface::PosVelAccJointInterface"},
    {JOINT_STATES, "hardware_interface::JointStateInterface"},
};

std::string interfaceOf(const std::string& type) {
  for (const TypeRow& row : TYPE_TABLE)
    if (type == row.type) return row.hardware_interface;
  return TYPE_TABLE.front().hardware_interface;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool shareAJoint(const TrajectoryController& a, const TrajectoryController& b) {
  return std::any_of(a.joints().begin(), a.joints().end(), [&](const std::string& joint) { return contains(b.joints(), joint); });
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "none" : text;
}

void checkName(const std::string& name) {
  std::string error;
  if (name.empty() || name.front() == '/' || !ros::names::validate(name, error))
    throw InputError("controllers: '" + name + "' is no name in a ROS namespace; use letters, digits, _ and /");
}

}  // namespace

RobotControllers::RobotControllers(ros::NodeHandle node, Simulator* simulator, int robot, StepSender* sender)
    : node_(node, simulator->robots()[robot].name_space), simulator_(simulator), robot_(robot), sender_(sender) {
  const auto& configured = simulator->config().robots[robot].controllers;
  for (const ControllerConfig& config : configured.value_or(std::vector<ControllerConfig>(1))) {
    checkName(config.name);
    const std::string type = controllerType(node_, config.name);
    add(withParameters(node_, config), type.empty() ? DEFAULT_TYPE : type);
    controllers_.back().gives_way = !configured;
  }
  startFirst();
}

void RobotControllers::startFirst() {
  for (Controller& controller : controllers_) {
    if (const Controller* rival = rivalOf(controller, {}))
      ROS_WARN("controller '%s' waits: '%s' has joints of it; switch_controller changes over", controller.name.c_str(),
               rival->name.c_str());
    else
      controller.running = controller.has_run = true;
  }
  for (Controller& controller : controllers_)
    if (!controller.running) controller.server->stop();
}

void RobotControllers::publish(const StepReport& report) {
  for (Controller& controller : controllers_)
    if (controller.server) controller.server->step(report.time);
}

void RobotControllers::timeRestarted() {
  for (Controller& controller : controllers_)
    if (controller.server) controller.server->restartTime();
}

const std::vector<std::string>& RobotControllers::types() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> built_in;
    for (const TypeRow& row : TYPE_TABLE) built_in.push_back(row.type);
    return built_in;
  }();
  return names;
}

std::vector<ControllerState> RobotControllers::list() const {
  std::vector<ControllerState> states;
  for (const Controller& controller : controllers_) {
    ControllerState state;
    state.name = controller.name;
    state.type = controller.type;
    state.state = controller.running ? "running" : controller.has_run ? "stopped" : "initialized";
    state.claimed_resources.resize(1);
    state.claimed_resources[0].hardware_interface = interfaceOf(controller.type);
    if (controller.server) state.claimed_resources[0].resources = controller.server->controller().joints();
    states.push_back(state);
  }
  return states;
}

void RobotControllers::add(const ControllerConfig& config, const std::string& type) {
  Controller controller;
  controller.name = config.name;
  controller.type = type;
  controller.server = std::make_unique<ControllerServer>(node_, TrajectoryController(simulator_, robot_, config), sender_);
  controllers_.push_back(std::move(controller));
}

void RobotControllers::load(const std::string& name) {
  checkName(name);
  if (find(name)) return;
  const std::string type = controllerType(node_, name), place = node_.resolveName(name);
  if (type.empty()) throw InputError("there is no string parameter " + place + "/type; load the controller's settings first");
  if (!contains(types(), type)) throw InputError(place + "/type: '" + type + "' is not built in; built in are " + joined(types()));
  if (type == JOINT_STATES) {
    controllers_.push_back({name, type, nullptr, false, false, false});
    return;
  }
  ControllerConfig config;
  config.name = name;
  config = withParameters(node_, config);
  if (config.joints.empty()) throw InputError(place + "/joints: is missing; list the controller's joints");
  add(config, type);
  controllers_.back().server->stop();
}

void RobotControllers::unload(const std::string& name) {
  const Controller* controller = find(name);
  if (!controller) throw InputError("there is no controller '" + name + "'; there are: " + joined(knownNames()));
  if (controller->running) throw InputError("controller '" + name + "' runs; stop it by switch_controller first");
  sender_->drain();  // its messages need its publisher
  controllers_.erase(controllers_.begin() + (controller - controllers_.data()));
}

std::vector<std::string> RobotControllers::change(const ControllerChange& change) {
  std::vector<std::string> obstacles;
  ControllerChange possible{{}, {}, change.strict};
  const auto sort = [&](const std::string& name, const std::string& obstacle, std::vector<std::string>* names) {
    if (obstacle.empty())
      names->push_back(name);
    else
      obstacles.push_back(obstacle);
  };
  for (const std::string& name : change.stop) sort(name, obstacleToStop(name), &possible.stop);
  for (const std::string& name : change.start) sort(name, obstacleToStart(name, possible), &possible.start);
  if (change.strict && !obstacles.empty()) throw InputError(joined(obstacles));
  for (const std::string& name : possible.stop) stop(find(name));
  for (const std::string& name : possible.start) start(find(name));
  return obstacles;
}

RobotControllers::Controller* RobotControllers::find(const std::string& name) {
  const auto at = std::find_if(controllers_.begin(), controllers_.end(), [&](const Controller& other) { return other.name == name; });
  return at == controllers_.end() ? nullptr : &*at;
}

std::vector<std::string> RobotControllers::knownNames() const {
  std::vector<std::string> names;
  for (const Controller& controller : controllers_) names.push_back(controller.name);
  return names;
}

RobotControllers::Controller* RobotControllers::rivalOf(const Controller& controller, const std::vector<std::string>& stopping) {
  if (!controller.server) return nullptr;
  for (Controller& other : controllers_) {
    if (&other == &controller || !other.running || !other.server || contains(stopping, other.name)) continue;
    if (shareAJoint(controller.server->controller(), other.server->controller())) return &other;
  }
  return nullptr;
}

std::string RobotControllers::obstacleToStop(const std::string& name) {
  const Controller* controller = find(name);
  if (!controller) return "there is no controller '" + name + "' to stop (there are: " + joined(knownNames()) + ")";
  return controller->running ? "" : "controller '" + name + "' does not run";
}

std::string RobotControllers::obstacleToStart(const std::string& name, const ControllerChange& change) {
  const Controller* controller = find(name);
  if (!controller) return "there is no controller '" + name + "' to start (there are: " + joined(knownNames()) + "); load it first";
  if (controller->running && !contains(change.stop, name)) return "";
  for (const std::string& other : change.start) {
    const Controller* started = find(other);
    if (other != name && started->server && controller->server &&
        shareAJoint(started->server->controller(), controller->server->controller()))
      return "controllers '" + name + "' and '" + other + "' have joints in common";
  }
  const Controller* rival = rivalOf(*controller, change.stop);
  return !rival || rival->gives_way ? "" : "controller '" + name + "' has joints of '" + rival->name + "', which runs; stop that one too";
}

void RobotControllers::start(Controller* controller) {
  if (controller->running) return;
  if (Controller* rival = rivalOf(*controller, {})) {
    ROS_INFO("controller '%s' gives way to '%s'", rival->name.c_str(), controller->name.c_str());
    stop(rival);
  }
  controller->running = controller->has_run = true;
  if (controller->server) controller->server->start();
}

void RobotControllers::stop(Controller* controller) {
  controller->running = false;
  if (controller->server) controller->server->stop();
}

}  // namespace blem_sim
