#include "controllers/robot_controllers.h"

#include <ros/console.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "controllers/controller_parameters.h"
#include "controllers/drive_server.h"
#include "controllers/gripper_server.h"
#include "controllers/trajectory_server.h"
#include "messages/ros_names.h"

namespace blem_sim::node {

namespace {

/** Built-in types, the interface of ros_control that each stands for, and what makes it; nothing makes joint states, which come anyway. */
struct TypeRow {
  const char* type;
  const char* hardware_interface;
  std::optional<sim::ControllerKind> kind;
};
constexpr char ACKERMANN[] = "ackermann_steering_controller/AckermannSteeringController";
const std::vector<TypeRow> TYPE_TABLE = {
    {"position_controllers/JointTrajectoryController", "hardware_interface::PositionJointInterface", sim::ControllerKind::TRAJECTORY},
    {"velocity_controllers/JointTrajectoryController", "hardware_interface::VelocityJointInterface", sim::ControllerKind::TRAJECTORY},
    {"effort_controllers/JointTrajectoryController", "hardware_interface::EffortJointInterface", sim::ControllerKind::TRAJECTORY},
    {"pos_vel_controllers/JointTrajectoryController", "hardware_interface::PosVelJointInterface", sim::ControllerKind::TRAJECTORY},
    {"pos_vel_acc_controllers/JointTrajectoryController", "hardware_interface::PosVelAccJointInterface", sim::ControllerKind::TRAJECTORY},
    {"position_controllers/GripperActionController", "hardware_interface::PositionJointInterface", sim::ControllerKind::GRIPPER},
    {"effort_controllers/GripperActionController", "hardware_interface::EffortJointInterface", sim::ControllerKind::GRIPPER},
    {"diff_drive_controller/DiffDriveController", "hardware_interface::VelocityJointInterface", sim::ControllerKind::DRIVE},
    {ACKERMANN, "hardware_interface::VelocityJointInterface", sim::ControllerKind::STEERED_DRIVE},
    {"blem_sim/PlanarDrive", "", sim::ControllerKind::PLANAR_DRIVE},
    {"joint_state_controller/JointStateController", "hardware_interface::JointStateInterface", {}},
};

/** Row of a type; null if it is not built in. */
const TypeRow* rowOf(const std::string& type) {
  const auto row = std::find_if(TYPE_TABLE.begin(), TYPE_TABLE.end(), [&](const TypeRow& other) { return type == other.type; });
  return row == TYPE_TABLE.end() ? nullptr : &*row;
}

/** Type of a configured controller: the parameter's if it is of the kind. */
std::string typeOfController(const std::string& parameter, sim::ControllerKind kind) {
  const TypeRow* given = rowOf(parameter);
  if (given && given->kind == kind) return parameter;
  return std::find_if(TYPE_TABLE.begin(), TYPE_TABLE.end(), [&](const TypeRow& row) { return row.kind == kind; })->type;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/** False if either is null. */
bool shareAJoint(const ControllerServer* a, const ControllerServer* b) {
  if (!a || !b) return false;
  const std::vector<std::string> joints = a->joints(), others = b->joints();
  return std::any_of(joints.begin(), joints.end(), [&](const std::string& joint) { return contains(others, joint); });
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "none" : text;
}

/** Nothing if the robot's configuration names none, or there is no configuration of that robot. */
std::optional<std::vector<sim::ControllerConfig>> configuredOf(const sim::Simulator& simulator, const std::string& robot) {
  for (const sim::RobotConfig& config : simulator.config().robots)
    if (config.name == robot) return config.controllers;
  return {};
}

/** The controller of all joints that no drive has; nothing if there is none left. */
std::vector<sim::ControllerConfig> ofOtherJoints(const sim::RobotInfo& robot) {
  sim::ControllerConfig config;
  if (robot.drives.empty()) return {config};
  const auto isDriven = [&](const std::string& joint) {
    return std::any_of(robot.drives.begin(), robot.drives.end(), [&](const auto& drive) { return contains(drive.joints, joint); });
  };
  for (std::size_t joint = 0; joint < robot.joint_names.size(); ++joint)
    if (robot.driven[joint] && !isDriven(robot.joint_names[joint])) config.joints.push_back(robot.joint_names[joint]);
  return config.joints.empty() ? std::vector<sim::ControllerConfig>() : std::vector<sim::ControllerConfig>{config};
}

void checkName(const std::string& name) {
  if (!isRosName(name) || name.front() == '/')
    throw InputError("controllers: '" + name + "' is no name in a ROS namespace; use letters, digits, _ and /");
}

}  // namespace

RobotControllers::RobotControllers(ros::NodeHandle node, SimulationLoop* loop, int robot)
    : node_(node, loop->simulator().robots()[robot].name_space),
      loop_(loop),
      simulator_(&loop->simulator()),
      robot_(simulator_->robots()[robot].name) {
  const auto configured = configuredOf(*simulator_, robot_);
  const sim::RobotInfo& info = simulator_->robots()[robot];
  for (const sim::ControllerConfig& config : configured.value_or(ofOtherJoints(info))) {
    addConfigured(config);
    controllers_.back().gives_way = !configured;
  }
  for (const sim::ControllerConfig& drive : info.drives) {
    try {
      addConfigured(drive);
    } catch (const InputError& error) {
      ROS_WARN("%s; the drive of its <gazebo> block is left out", error.what());
    }
  }
  startFirst();
}

void RobotControllers::addConfigured(const sim::ControllerConfig& config) {
  checkName(config.name);
  add(withParameters(node_, config), typeOfController(controllerType(node_, config.name), config.kind));
}

void RobotControllers::startFirst() {
  for (Controller& controller : controllers_) {
    if (const Controller* rival = rivalOf(controller, {}))
      ROS_WARN("controller '%s' waits: '%s' has joints of it; switch_controller changes over", controller.name.c_str(),
               rival->name.c_str());
    else
      start(&controller);
  }
}

void RobotControllers::step(double time) {
  for (Controller& controller : controllers_)
    if (controller.server) controller.server->step(time);
}

void RobotControllers::restartTime() {
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
    state.claimed_resources[0].hardware_interface = rowOf(controller.type)->hardware_interface;
    if (controller.server) state.claimed_resources[0].resources = controller.server->joints();
    states.push_back(state);
  }
  return states;
}

void RobotControllers::add(const sim::ControllerConfig& config, const std::string& type) {
  Controller controller;
  controller.name = config.name;
  controller.type = type;
  const int robot = simulator_->robotIndex(robot_);
  if (config.kind == sim::ControllerKind::GRIPPER)
    controller.server = std::make_unique<GripperServer>(node_, sim::GripperController(simulator_, robot, config), loop_->refusals());
  else if (sim::isDrive(config.kind))
    controller.server = std::make_unique<DriveServer>(node_, sim::DriveController(simulator_, robot, config), loop_);
  else
    controller.server = std::make_unique<TrajectoryServer>(node_, sim::TrajectoryController(simulator_, robot, config), loop_);
  controllers_.push_back(std::move(controller));
}

void RobotControllers::load(const std::string& name) {
  checkName(name);
  if (find(name)) return;
  const std::string type = controllerType(node_, name), place = node_.resolveName(name);
  if (type.empty()) throw InputError("there is no string parameter " + place + "/type; load the controller's settings first");
  const TypeRow* row = rowOf(type);
  if (!row) throw InputError(place + "/type: '" + type + "' is not built in; built in are " + listed(types()));
  if (!row->kind) {
    controllers_.push_back({name, type, nullptr, false, false, false});
    return;
  }
  sim::ControllerConfig config;
  config.name = name;
  config.kind = *row->kind;
  config.drive.steering.takes_angles = type == ACKERMANN;  // as that one does
  config = withParameters(node_, config);
  if (config.joints.empty() && config.kind != sim::ControllerKind::PLANAR_DRIVE)
    throw InputError(place + "/joints: is missing; list the controller's joints");
  add(config, type);
}

void RobotControllers::unload(const std::string& name) {
  const Controller* controller = find(name);
  if (!controller) throw InputError("there is no controller '" + name + "'; there are: " + listed(knownNames()));
  if (controller->running) throw InputError("controller '" + name + "' runs; stop it by switch_controller first");
  loop_->sender()->drain();  // its messages need its publisher
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
  if (change.strict && !obstacles.empty()) throw InputError(listed(obstacles));
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
  for (Controller& other : controllers_) {
    if (&other == &controller || !other.running || contains(stopping, other.name)) continue;
    if (shareAJoint(controller.server.get(), other.server.get())) return &other;
  }
  return nullptr;
}

std::string RobotControllers::obstacleToStop(const std::string& name) {
  const Controller* controller = find(name);
  if (!controller) return "there is no controller '" + name + "' to stop (there are: " + listed(knownNames()) + ")";
  return controller->running ? "" : "controller '" + name + "' does not run";
}

std::string RobotControllers::obstacleToStart(const std::string& name, const ControllerChange& change) {
  const Controller* controller = find(name);
  if (!controller) return "there is no controller '" + name + "' to start (there are: " + listed(knownNames()) + "); load it first";
  if (controller->running && !contains(change.stop, name)) return "";
  for (const std::string& other : change.start)
    if (other != name && shareAJoint(find(other)->server.get(), controller->server.get()))
      return "controllers '" + name + "' and '" + other + "' have joints in common";
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

}  // namespace blem_sim::node
