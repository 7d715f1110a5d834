#include "build/robot_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/range_view.h"
#include "build/by_joint.h"
#include "build/frame_prefix.h"
#include "build/robot_motors.h"
#include "build/robot_names.h"
#include "gazebo/gazebo_names.h"

namespace blem_sim::sim {
namespace {

constexpr const char* TRUE_ODOMETRY = "ground_truth/odom";  // topic, where a drive has that of the configuration

std::set<std::string> jointsWithSensor(const RobotConfig& config) {
  std::set<std::string> joints;
  for (const SensorConfig& sensor : config.sensors)
    if (sensor.type == SensorType::FORCE_TORQUE) joints.insert(sensor.joint);
  return joints;
}

int lumpedJointIndex(const model::LumpedRobot& robot, const std::string& name) {
  for (std::size_t i = 0; i < robot.joints.size(); ++i)
    if (robot.joints[i].name == name) return static_cast<int>(i);
  return -1;
}

dynamics::JointKind kindOf(model::JointType type) {
  if (type == model::JointType::FIXED) return dynamics::JointKind::FIXED;
  return type == model::JointType::PRISMATIC ? dynamics::JointKind::PRISMATIC : dynamics::JointKind::REVOLUTE;
}

/** Joints in an order where those that others mimic come first. */
std::vector<int> mastersFirst(const model::LumpedRobot& robot, const std::string& where) {
  std::vector<int> order;
  std::vector<bool> placed(robot.joints.size(), false);
  while (order.size() < robot.joints.size()) {
    const std::size_t before = order.size();
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const model::LumpedJoint& joint = robot.joints[j];
      if (placed[j]) continue;
      if (joint.mimic) {
        const int master = lumpedJointIndex(robot, joint.mimic->joint);
        if (master < 0 || !robot.joints[master].moves())
          throw InputError(
              fmt::format("{}: joint '{}' mimics '{}', which does not move; correct <mimic>", where, joint.name, joint.mimic->joint));
        if (!placed[master]) continue;
      }
      placed[j] = true;
      order.push_back(static_cast<int>(j));
    }
    if (order.size() == before) throw InputError(where + ": its mimic joints mimic each other in a circle; correct <mimic>");
  }
  return order;
}

}  // namespace

RobotBuilder::RobotBuilder(const RobotConfig& config, const ContactConfig& contact, const std::shared_ptr<const model::RobotModel>& model)
    : RobotBuilder(withGazeboBlocks(config, *model), contact, model) {}

RobotBuilder::RobotBuilder(const GazeboRobot& robot, const ContactConfig& contact, std::shared_ptr<const model::RobotModel> model)
    : config_(robot.config), contact_(contact), model_(std::move(model)), start_notes_(robot.notes) {
  // The check below refuses a sensor at an unknown joint.
  lumped_ = std::make_shared<const model::LumpedRobot>(model::lumpFixedJoints(*model_, jointsWithSensor(config_), config_.fixed_base));
  checkRobotNames(config_, *model_, *lumped_);
  checkMotors(config_);
  placeBodies();
}

double RobotBuilder::initialPosition(const model::LumpedJoint& joint) const {
  const auto given = config_.initial_positions.find(joint.name);
  return given == config_.initial_positions.end() ? 0 : given->second;
}

void RobotBuilder::placeBodies() {
  const std::vector<model::LumpedJoint>& joints = lumped_->joints;
  positions_.assign(joints.size(), 0);
  for (const int j : mastersFirst(*lumped_, "robots: " + config_.name)) {
    const model::LumpedJoint& joint = joints[j];
    if (!joint.moves()) continue;
    if (joint.mimic) {
      positions_[j] = joint.mimic->multiplier * positions_[lumpedJointIndex(*lumped_, joint.mimic->joint)] + joint.mimic->offset;
      continue;
    }
    const double wanted = initialPosition(joint);
    positions_[j] = std::max(joint.limits.lower, std::min(joint.limits.upper, wanted));
    if (positions_[j] != wanted)
      start_notes_.push_back(fmt::format("joint '{}' starts at {:.6g}, its limit, not at {:.6g}", joint.name, positions_[j], wanted));
  }
  X_WB_.assign(lumped_->bodies.size(), config_.X_WR);
  for (std::size_t j = 0; j < joints.size(); ++j) X_WB_[joints[j].child] = X_WB_[joints[j].parent] * joints[j].pose(positions_[j]);
}

void RobotBuilder::addTo(SimulatedWorld* world, SurfaceLibrary* surfaces) {
  world_ = world;
  info_.name = config_.name;
  info_.name_space = config_.name_space;
  info_.fixed_base = config_.fixed_base;
  info_.description = model_;
  info_.lumped = lumped_;
  info_.root_link = model_->links[model_->root].name;
  info_.X_WR = config_.X_WR;
  nameFrames();
  info_.model = world->addModel(config_.name, ModelKind::ROBOT, config_.max_contacts.value_or(contact_.max_contacts_per_robot));
  for (const auto* notes : {&model_->notes, &lumped_->notes, &std::as_const(start_notes_)})
    for (const std::string& words : *notes) note(words);
  addBodies();
  addJoints();
  addColliders(surfaces);
  setSelfCollision();
  disableNeighbours();
  disableListedPairs();
  partAtStart();
  ModelInfo& model = world->models[info_.model];
  for (const int body : info_.bodies)
    if (body != dynamics::WORLD_BODY) model.bodies.push_back(body);
  model.joints = info_.joints;
  for (const std::string& link : config_.weightless_links) {
    const int index = model_->linkIndex(link), body = info_.bodies[lumped_->link_placement[index].body];
    if (body != dynamics::WORLD_BODY) model.weightless.insert({body, index});
  }
  model.X_WM = config_.X_WR;
  addSensors(world->addRobot(info_));
}

void RobotBuilder::note(const std::string& words) {
  const std::string of_inline_urdf = "robots: " + config_.name + ": ";
  const bool is_named = words.compare(0, of_inline_urdf.size(), of_inline_urdf) == 0;
  world_->notes.push_back(config_.name + ": " + words.substr(is_named ? of_inline_urdf.size() : 0));
}

void RobotBuilder::nameFrames() {
  info_.publish_tf = config_.publish_tf;
  info_.odom = config_.odom;
  info_.tf_prefix = framePrefix(config_, *model_, world_->robots, &start_notes_);
  if (info_.root_link == WORLD_LINK) tellOfWorldLink();
  yieldToDrives();
}

void RobotBuilder::yieldToDrives() {
  info_.drives = config_.drives;
  std::vector<ControllerConfig> drives = config_.drives;
  for (const ControllerConfig& controller : config_.controllers.value_or(std::vector<ControllerConfig>()))
    if (isDrive(controller.kind)) drives.push_back(controller);
  for (const ControllerConfig& controller : drives) {
    if (controller.drive.publish_rate == RATE_OFF) continue;
    const std::string topic = resolvedTopic(info_.name_space, odometryTopic(controller));
    if (topic != resolvedTopic(info_.name_space, info_.odom.topic)) continue;
    info_.odom.topic = TRUE_ODOMETRY;
    start_notes_.push_back(fmt::format("{} has the odometry of '{}'; the truth is on {}", topic, controller.name, TRUE_ODOMETRY));
  }
}

void RobotBuilder::tellOfWorldLink() {
  if (!config_.fixed_base)
    start_notes_.push_back("its root link 'world' moves freely; set fixed_base to hold it");
  else if (info_.tf_prefix.empty() && !config_.X_WR.isApprox(Pose::Identity()))
    start_notes_.push_back(
        "its root link 'world' is the frame 'world' on /tf, which does not show its pose; rename the link, or set tf_prefix");
}

void RobotBuilder::setSelfCollision() {
  std::set<int> links;
  for (const std::string& link : config_.self_colliding_links) links.insert(model_->linkIndex(link));
  if (config_.self_collision)
    world_->filter.setSelfCollision(info_.model, *config_.self_collision);
  else
    world_->filter.setSelfCollidingLinks(info_.model, links);
}

void RobotBuilder::addBodies() {
  for (std::size_t b = 0; b < lumped_->bodies.size(); ++b) {
    if (b == 0 && config_.fixed_base) {
      info_.bodies.push_back(dynamics::WORLD_BODY);
      continue;
    }
    dynamics::BodySpec spec;
    spec.name = config_.name + "::" + lumped_->bodies[b].name;
    spec.inertial = lumped_->bodies[b].inertial;
    spec.X_WB = X_WB_[b];
    info_.bodies.push_back(world_->addBody(spec));
  }
}

void RobotBuilder::addJoints() {
  const RobotMotors motors = robotMotors(config_, *model_, *lumped_, positions_, world_->gravityToHold());
  for (const std::string& words : motors.notes) note(words);
  info_.world_joints.assign(lumped_->joints.size(), -1);
  for (const int j : mastersFirst(*lumped_, "robots: " + config_.name))
    if (lumped_->joints[j].type != model::JointType::FLOATING) addJoint(j, motors.settings[j]);
  for (std::size_t j = 0; j < lumped_->joints.size(); ++j) {
    const model::LumpedJoint& joint = lumped_->joints[j];
    if (!joint.moves()) continue;
    info_.joint_names.push_back(joint.name);
    info_.joints.push_back(info_.world_joints[j]);
    info_.limits.push_back(joint.limits);
    info_.continuous.push_back(joint.type == model::JointType::CONTINUOUS);
    info_.driven.push_back(!joint.mimic);
  }
}

void RobotBuilder::addJoint(int j, const MotorSettings& motor) {
  const model::LumpedJoint& joint = lumped_->joints[j];
  dynamics::JointSpec spec;
  spec.name = config_.name + "::" + joint.name;
  spec.kind = kindOf(joint.type);
  spec.parent = info_.bodies[joint.parent];
  spec.child = info_.bodies[joint.child];
  spec.X_PJ = spec.parent == dynamics::WORLD_BODY ? config_.X_WR * joint.X_PJ : joint.X_PJ;
  spec.axis = joint.axis;
  if (joint.type != model::JointType::CONTINUOUS) {
    spec.lower = joint.limits.lower;
    spec.upper = joint.limits.upper;
  }
  if (joint.mimic && joint.moves()) {
    spec.mimic_joint = info_.world_joints[lumpedJointIndex(*lumped_, joint.mimic->joint)];
    spec.mimic_multiplier = joint.mimic->multiplier;
    spec.mimic_offset = joint.mimic->offset;
  }
  if (joint.moves()) spec.armature = byJoint(config_.armature, joint.name, 0.0);
  info_.world_joints[j] = world_->addJoint(spec, positions_[j], JointMotor(motor, positions_[j]));
}

void RobotBuilder::addSensors(int robot) {
  for (SensorConfig sensor : config_.sensors) {
    if (sensor.type == SensorType::FORCE_TORQUE) placeWrench(&sensor);
    const std::string frame = sensor.type == SensorType::MOTOR_CURRENT ? info_.root_link : sensor.link;
    world_->sensors.push_back({robot, sensor, frame});
    checkFrame(sensor);
  }
}

void RobotBuilder::placeWrench(SensorConfig* sensor) const {
  const model::JointModel& joint = model_->joints[model_->jointIndex(sensor->joint)];
  const bool of_joint = sensor->frame == "sensor";
  sensor->X_LS = of_joint ? joint.X_PJ : Pose::Identity();
  if (of_joint || sensor->frame == "parent")
    sensor->link = model_->links[joint.parent].name;
  else
    sensor->link = sensor->frame == "child" ? model_->links[joint.child].name : sensor->frame;
}

// A frame_id that is a link's name claims that the readings are in that link's axes.
void RobotBuilder::checkFrame(const SensorConfig& sensor) {
  const int claimed = model_->linkIndex(sensor.frame_id), own = model_->linkIndex(sensor.link);
  if (claimed < 0 || own < 0 || sensor.type == SensorType::ODOMETRY) return;
  Pose X_LS = sensor.X_LS;
  if (sensor.type == SensorType::DEPTH_CAMERA) X_LS.linear() = X_LS.linear() * opticalAxes();
  const model::LinkPlacement &at_claimed = lumped_->link_placement[claimed], &at_own = lumped_->link_placement[own];
  const Matrix3 R_FS = at_claimed.X_BL.linear().transpose() * at_own.X_BL.linear() * X_LS.linear();
  if (at_claimed.body == at_own.body && R_FS.isIdentity(1e-6)) return;
  note(
      fmt::format("sensor '{}': its frame_id says '{}', whose axes are not those of its readings; take a link that is turned as they are, "
                  "or leave it out",
                  sensor.name, sensor.frame_id));
}

}  // namespace blem_sim::sim
