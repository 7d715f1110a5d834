#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>

#include <fmt/format.h>

#include "blem_sim/geometry/one_line.h"
#include "blem_sim/model/loaders.h"
#include "checks/file_check.h"
#include "checks/urdf_check.h"
#include "collision_shapes.h"
#include "inertia.h"

namespace blem_sim::model {
namespace {

/** URDF has no word for "no limit"; files write a large number. */
constexpr double NO_LIMIT = 1e6;

double withoutLimit(double value) {
  if (std::abs(value) < NO_LIMIT) return value;
  return std::copysign(std::numeric_limits<double>::infinity(), value);
}

/** Keeps urdfdom's messages instead of printing them. */
class UrdfdomMessages : public console_bridge::OutputHandler {
 public:
  UrdfdomMessages() { console_bridge::useOutputHandler(this); }
  ~UrdfdomMessages() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_error_.empty()) first_error_ = text;
  }
  const std::string& firstError() const { return first_error_; }

 private:
  std::string first_error_;
};

urdf::ModelInterfaceSharedPtr parseQuietly(const std::string& xml, const std::string& source) {
  static std::mutex handler_mutex;  // console_bridge has one output handler per process
  const std::lock_guard<std::mutex> lock(handler_mutex);
  const UrdfdomMessages messages;
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(xml);
  if (!model || !messages.firstError().empty()) {  // a model with errors lacks parts of its links
    throw InputError(
        fmt::format("{}: not a URDF: {}; correct it (check_urdf FILE says more)", source, geometry::oneLine(messages.firstError())));
  }
  return model;
}

std::optional<Inertial> toInertial(const urdf::Link& link) {
  if (!link.inertial) return std::nullopt;
  const urdf::Inertial& given = *link.inertial;
  Inertial at_com;
  at_com.mass = given.mass;
  at_com.inertia << given.ixx, given.ixy, given.ixz, given.ixy, given.iyy, given.iyz, given.ixz, given.iyz, given.izz;
  return movedTo(toPose(given.origin), at_com);
}

JointType toJointType(int type) {
  switch (type) {
    case urdf::Joint::REVOLUTE:
      return JointType::REVOLUTE;
    case urdf::Joint::CONTINUOUS:
      return JointType::CONTINUOUS;
    case urdf::Joint::PRISMATIC:
      return JointType::PRISMATIC;
    case urdf::Joint::PLANAR:
      return JointType::PLANAR;
    case urdf::Joint::FLOATING:
      return JointType::FLOATING;
    default:
      return JointType::FIXED;
  }
}

JointLimits toLimits(const urdf::Joint& joint, JointType type) {
  JointLimits limits;
  if (!joint.limits) return limits;
  if (type == JointType::REVOLUTE || type == JointType::PRISMATIC) {
    limits.lower = withoutLimit(joint.limits->lower);
    limits.upper = withoutLimit(joint.limits->upper);
  }
  limits.effort = withoutLimit(joint.limits->effort);
  limits.velocity = withoutLimit(joint.limits->velocity);
  return limits;
}

JointModel toJoint(const urdf::Joint& given, const RobotModel& robot) {
  JointModel joint;
  joint.name = given.name;
  joint.type = toJointType(given.type);
  joint.parent = robot.linkIndex(given.parent_link_name);
  joint.child = robot.linkIndex(given.child_link_name);
  joint.X_PJ = toPose(given.parent_to_joint_origin_transform);
  if (joint.type != JointType::FIXED && joint.type != JointType::FLOATING)
    joint.axis = Vector3(given.axis.x, given.axis.y, given.axis.z).normalized();
  joint.limits = toLimits(given, joint.type);
  if (given.dynamics) {
    joint.dry_friction = given.dynamics->friction;
    joint.viscous_friction = given.dynamics->damping;
  }
  if (given.safety)
    joint.safety = SafetyController{given.safety->soft_lower_limit, given.safety->soft_upper_limit, given.safety->k_position,
                                    given.safety->k_velocity};
  if (given.mimic) joint.mimic = Mimic{given.mimic->joint_name, given.mimic->multiplier, given.mimic->offset};
  return joint;
}

/** Parents first: each time the first joint in the file whose parent link is already reached. */
std::vector<JointModel> parentsFirst(const std::vector<JointModel>& joints, std::size_t links, int root) {
  std::vector<bool> reached(links, false), taken(joints.size(), false);
  reached[root] = true;
  std::vector<JointModel> sorted;
  while (sorted.size() < joints.size()) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (taken[i] || !reached[joints[i].parent]) continue;
      taken[i] = reached[joints[i].child] = true;
      sorted.push_back(joints[i]);
      break;
    }
  }
  return sorted;
}

/** @param read of that name by urdfdom, whose XML reader has another way with entities that are none
 *  @throws InputError if there is nothing */
template <typename T>
const T& found(const std::shared_ptr<T>& read, const std::string& kind, const std::string& name, const std::string& source) {
  if (!read) throw InputError(fmt::format("{}: {} '{}': the name is not readable XML; write & as &amp; and < as &lt;", source, kind, name));
  return *read;
}

void readLinks(const urdf::ModelInterface& model, const UrdfOutline& outline, const LoadProgress& progress, CollisionShapeReader* shapes,
               RobotModel* robot) {
  for (const std::string& name : outline.links) {
    const double read = static_cast<double>(robot->links.size()) / static_cast<double>(outline.links.size());
    if (progress) progress(fmt::format("reading link '{}'", name), (1 - TREE_FRACTION) * read);
    const urdf::Link& given = found(model.getLink(name), "link", name, robot->source);
    LinkModel link;
    link.name = name;
    link.inertial = toInertial(given);
    link.collisions = shapes->read(given, fmt::format("{}: link '{}'", robot->source, name), &robot->notes);
    for (CollisionShape& shape : link.collisions) shape.report.name = robot->name + "::" + name;
    robot->links.push_back(link);
  }
}

void addNotes(RobotModel* robot) {
  for (const JointModel& joint : robot->joints) {
    const bool ranged = joint.type == JointType::REVOLUTE || joint.type == JointType::PRISMATIC;
    if (ranged && joint.limits.lower == joint.limits.upper)
      robot->notes.push_back(fmt::format("joint '{}': lower and upper limit are both {}: it cannot move", joint.name, joint.limits.lower));
  }
  const bool touches =
      std::any_of(robot->links.begin(), robot->links.end(), [](const LinkModel& link) { return !link.collisions.empty(); });
  if (!touches) robot->notes.push_back("the robot has no <collision>: it touches nothing");
}

RobotModel readRobot(const std::string& xml, const std::string& source, CollisionShapeReader* shapes, const LoadProgress& progress) {
  const UrdfOutline outline = checkUrdf(xml, source);
  const urdf::ModelInterfaceSharedPtr model = parseQuietly(outline.simulated, source);
  RobotModel robot;
  robot.name = model->getName();
  robot.source = source;
  robot.notes = outline.notes;
  robot.transmissions = outline.transmissions;
  robot.gazebo = outline.gazebo;
  readLinks(*model, outline, progress, shapes, &robot);
  robot.root = robot.linkIndex(model->getRoot()->name);
  std::vector<JointModel> joints;
  for (const std::string& name : outline.joints) joints.push_back(toJoint(found(model->getJoint(name), "joint", name, source), robot));
  robot.joints = parentsFirst(joints, robot.links.size(), robot.root);
  addNotes(&robot);
  return robot;
}

}  // namespace

RobotModel loadUrdf(const std::string& xml, const std::string& source, const UriResolver& resolver, const UrdfOptions& options) {
  CollisionShapeReader shapes(resolver, options.base, options.mending);
  try {
    return readRobot(xml, source, &shapes, options.progress);
  } catch (const InputError& error) {
    throw InputError(geometry::oneLine(error.what()));  // names in a URDF may hold anything
  }
}

RobotModel loadUrdfFile(const std::string& file, const UriResolver& resolver, UrdfOptions options) {
  if (options.base.empty()) options.base = std::filesystem::absolute(file).parent_path().string();
  return loadUrdf(readBytes(file), file, resolver, options);
}

}  // namespace blem_sim::model
