#include "config/config_sections.h"

namespace blem_sim::sim {

namespace {

const char* const DEFAULT = "default";

/** First value of a joint, for fields that its own entry leaves out: the entry "default", if there is one. */
template <typename Value>
Value inherited(const std::map<std::string, Value>& by_joint) {
  const auto entry = by_joint.find(DEFAULT);
  return entry == by_joint.end() ? Value() : entry->second;
}

/** Reads "default" first, so that the others can start from it. */
template <typename Value, typename Read>
std::map<std::string, Value> readByJoint(YamlReader& reader, const std::string& key, Read read) {
  std::map<std::string, Value> by_joint;
  for (const bool defaults : {true, false}) {
    reader.forEachName(key, [&](const std::string& name, YamlReader& map) {
      if ((name == DEFAULT) != defaults) return;
      Value value = inherited(by_joint);
      read(name, map, &value);
      by_joint[name] = value;
    });
  }
  return by_joint;
}

void readGains(const std::string& name, YamlReader& map, JointGains* gains) {
  YamlReader reader = map.section(name);
  reader.read("p", &gains->p, NumberRange::notNegative());
  reader.read("i", &gains->i, NumberRange::notNegative());
  reader.read("d", &gains->d, NumberRange::notNegative());
  reader.read("i_clamp", &gains->i_clamp, NumberRange::notNegativeOrInfinite());
  reader.finish();
}

void readJointFriction(const std::string& name, YamlReader& map, JointFriction* friction) {
  YamlReader reader = map.section(name);
  reader.read("dry", &friction->dry, NumberRange::notNegative());
  reader.read("viscous", &friction->viscous, NumberRange::notNegative());
  reader.finish();
}

MotorDefault readMotorDefault(YamlReader& reader) {
  return static_cast<MotorDefault>(reader.choice("motors", {"computed", "transmissions", "free"}).value_or(0));
}

MotorLaw motorLaw(YamlReader& reader, const std::string& key) {
  return reader.choice(key, {"pid", "implicit_pd"}).value_or(0) == 1 ? MotorLaw::IMPLICIT_PD : MotorLaw::PID;
}

/** `motor: pid` for all joints, or a map by joint. */
std::map<std::string, MotorLaw> readMotor(YamlReader& reader) {
  const YAML::Node given = reader.node("motor");
  if (!given.IsDefined()) return {};
  if (given.IsScalar()) return {{DEFAULT, motorLaw(reader, "motor")}};
  std::map<std::string, MotorLaw> laws;
  reader.forEachName("motor", [&](const std::string& name, YamlReader& map) { laws[name] = motorLaw(map, name); });
  return laws;
}

std::map<std::string, double> readNumbers(YamlReader& reader, const std::string& key, const NumberRange& range) {
  std::map<std::string, double> numbers;
  reader.forEachName(key, [&](const std::string& name, YamlReader& map) { map.read(name, &numbers[name], range); });
  return numbers;
}

std::vector<std::pair<std::string, std::string>> readPairs(YamlReader& reader, const std::string& key) {
  std::vector<std::pair<std::string, std::string>> pairs;
  const YAML::Node list = reader.node(key);
  if (!list.IsDefined()) return pairs;
  const std::string wanted = "must be a list of pairs of links: [[LinkA, LinkB], ...]";
  if (!list.IsSequence()) reader.refuse(key, wanted);
  for (const auto& pair : list) {
    if (!pair.IsSequence() || pair.size() != 2 || !pair[0].IsScalar() || !pair[1].IsScalar()) reader.refuse(key, wanted);
    pairs.emplace_back(pair[0].Scalar(), pair[1].Scalar());
  }
  return pairs;
}

std::set<std::string> readNames(YamlReader& reader, const std::string& key) {
  const YAML::Node list = reader.node(key);
  if (!list.IsDefined()) return {};
  std::set<std::string> names;
  if (!list.IsSequence()) reader.refuse(key, "must be a list of links: [LinkA, LinkB, ...]");
  for (const auto& name : list) {
    if (!name.IsScalar()) reader.refuse(key, "must be a list of links: [LinkA, LinkB, ...]");
    names.insert(name.Scalar());
  }
  return names;
}

OdometryConfig readOdometryTopic(YamlReader reader) {
  OdometryConfig odometry;
  reader.read("topic", &odometry.topic);
  reader.read("frame", &odometry.frame);
  reader.read("pose", &odometry.X_WF);
  for (const auto& [key, given] : {std::make_pair("topic", odometry.topic), std::make_pair("frame", odometry.frame)})
    if (given.empty()) reader.refuse(key, "is empty; leave it out, or give it a name");
  reader.finish();
  return odometry;
}

void readSource(YamlReader& reader, RobotConfig* robot) {
  reader.read("urdf", &robot->urdf);
  reader.read("description_param", &robot->description_param);
  if (robot->urdf.empty() == robot->description_param.empty())
    reader.refuse("", "needs exactly one of urdf (a file) or description_param (a ROS parameter)");
  reader.read("namespace", &robot->name_space);
}

}  // namespace

std::map<std::string, JointGains> parsePidGains(const YAML::Node& node, const std::string& source) {
  YAML::Node root;
  root["pid_gains"] = node;
  YamlReader reader(root, source);
  std::map<std::string, JointGains> by_joint;
  reader.forEachName("pid_gains", [&](const std::string& joint, YamlReader& map) {
    YamlReader gains = map.section(joint);
    JointGains& out = by_joint[joint];
    gains.read("p", &out.p, NumberRange::notNegative());
    gains.read("i", &out.i, NumberRange::notNegative());
    gains.read("d", &out.d, NumberRange::notNegative());
    for (const char* key : {"i_clamp_max", "i_clamp"}) gains.read(key, &out.i_clamp, NumberRange::notNegativeOrInfinite());
  });
  return by_joint;
}

RobotConfig readRobot(YamlReader& reader) {
  RobotConfig robot;
  robot.name = readName(reader);
  readSource(reader, &robot);
  reader.read("fixed_base", &robot.fixed_base);
  reader.read("pose", &robot.X_WR);
  robot.initial_positions = readNumbers(reader, "initial_positions", NumberRange::any());
  reader.read("self_collision", &robot.self_collision);
  robot.self_colliding_links = readNames(reader, "self_colliding_links");
  robot.disable_collisions = readPairs(reader, "disable_collisions");
  robot.contact = readContactOverrides(reader);
  reader.read("max_contacts_per_robot", &robot.max_contacts, 1);
  reader.forEachName("links", [&](const std::string& name, YamlReader& map) {
    YamlReader link = map.section(name);
    robot.links[name] = readContactOverrides(link);
    link.finish();
  });
  robot.gains = readByJoint<JointGains>(reader, "gains", readGains);
  robot.motors = readMotorDefault(reader);
  robot.motor = readMotor(reader);
  robot.joint_friction = readByJoint<JointFriction>(reader, "joint_friction", readJointFriction);
  robot.effort_limits = readNumbers(reader, "effort_limits", NumberRange::notNegativeOrInfinite());
  robot.velocity_limits = readNumbers(reader, "velocity_limits", NumberRange::positiveOrInfinite());
  reader.read("command_timeout", &robot.command_timeout, NumberRange::notNegative());
  robot.armature = readNumbers(reader, "armature", NumberRange::notNegative());
  robot.sensors = readSensors(reader);
  robot.controllers = readControllers(reader);
  reader.read("tf_prefix", &robot.tf_prefix);
  reader.read("publish_tf", &robot.publish_tf);
  robot.odom = readOdometryTopic(reader.section("odom"));
  return robot;
}

}  // namespace blem_sim::sim
