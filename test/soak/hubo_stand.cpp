#include "soak/hubo_stand.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "build/robot_builder.h"
#include "support/shared_packages.h"

namespace blem_sim {
namespace {

constexpr double SOLE_THICKNESS = 1e-3;  // [m] vertices this near to a foot's lowest one span the sole

YAML::Node sharedYaml(const std::string& path) { return YAML::LoadFile(*sharedData(path)); }

Vector3 vector3(const YAML::Node& node) { return {node[0].as<double>(), node[1].as<double>(), node[2].as<double>()}; }

/** Meshes are read once for all stands. */
std::shared_ptr<const model::RobotModel> huboModel() {
  static const auto model = std::make_shared<const model::RobotModel>(
      model::loadUrdfFile(*sharedData(std::string(HUBO_FOLDER) + "/huboplus.urdf"), model::UriResolver(sharedPackages())));
  return model;
}

sim::JointTrajectory motionWithRoot(const std::string& motion) {
  std::vector<std::string> columns = {"root_x", "root_y", "root_z", "root_roll", "root_pitch", "root_yaw"};
  for (const model::JointModel& joint : huboModel()->joints) columns.push_back(joint.name);
  std::vector<std::string> ignored;
  return sim::loadTrajectoryCsv(*sharedData(motion), columns, &ignored);
}

void startAt(const std::string& motion, sim::RobotConfig* config) {
  const sim::JointTrajectory trajectory = motionWithRoot(motion);
  std::map<std::string, double> first;
  for (std::size_t i = 0; i < trajectory.joints.size(); ++i) first[trajectory.joints[i]] = trajectory.points.front().positions[i];
  config->X_WR =
      makePose({first["root_x"], first["root_y"], first["root_z"]}, {first["root_roll"], first["root_pitch"], first["root_yaw"]});
  for (const model::JointModel& joint : huboModel()->joints)
    if (first.count(joint.name)) config->initial_positions[joint.name] = first[joint.name];
}

bool isFinger(const std::string& joint) { return joint.find("left") == 0 || joint.find("right") == 0; }

void setDriver(const YAML::Node& driver, const HuboOptions& options, sim::RobotConfig* config) {
  const std::string joint = driver["joint"].as<std::string>();
  sim::JointGains gains;
  gains.p = driver["servoP"].as<double>();
  gains.d = driver["servoD"].as<double>();
  if (options.finger_stiffness && isFinger(joint)) gains.p = *options.finger_stiffness;
  if (options.stiffness) gains = {*options.stiffness, 0, 0};
  config->gains[joint] = gains;
  config->joint_friction[joint] = sim::JointFriction();
  if (options.joint_friction) config->joint_friction[joint] = {driver["dryFriction"].as<double>(), driver["viscousFriction"].as<double>()};
  if (options.stiffness) config->effort_limits[joint] = std::numeric_limits<double>::infinity();
}

sim::RobotConfig huboConfig(const YAML::Node& world, const HuboOptions& options) {
  const YAML::Node robot = world["robots"][0], description = sharedYaml(std::string(HUBO_FOLDER) + "/huboplus.yaml");
  sim::RobotConfig config;
  config.name = "hubo";
  config.motors = sim::MotorDefault::FREE;
  config.X_WR = makePose(vector3(robot["base_xyz"]), vector3(robot["base_rpy"]));
  for (const auto& entry : robot["joint_positions"]) config.initial_positions[entry.first.as<std::string>()] = entry.second.as<double>();
  if (!options.start_at.empty()) startAt(options.start_at, &config);
  config.motor["default"] = sim::MotorLaw::IMPLICIT_PD;
  for (const auto& driver : description["drivers"]) setDriver(driver, options, &config);
  for (const model::JointModel& joint : huboModel()->joints)
    if (!config.effort_limits.count(joint.name)) config.effort_limits[joint.name] = options.effort_scale * joint.limits.effort;
  return config;
}

/** Stiffness or damping of two springs or dampers in a row. */
double inRow(double a, double b) { return a * b / (a + b); }

dynamics::Surface footOnGround(const YAML::Node& world, bool compliant) {
  const YAML::Node foot = world["robots"][0]["link_surfaces"][0], ground = world["terrains"][0];
  dynamics::Surface surface;
  surface.friction = 2 / (1 / foot["kFriction"].as<double>() + 1 / ground["kFriction"].as<double>());
  if (!compliant) return surface;
  surface.stiffness = inRow(foot["stiffness"].as<double>(), ground["kStiffness"].as<double>());
  surface.damping = inRow(foot["damping"].as<double>(), ground["kDamping"].as<double>());
  return surface;
}

/** Bounds of a link's meshes in its body's frame, as far up from its lowest vertex as asked. */
Box linkBounds(const sim::RobotInfo& robot, int link, double height) {
  Box all, lowest;
  const Pose& X_BL = robot.lumped->link_placement[link].X_BL;
  for (const model::CollisionShape& shape : robot.description->links[link].collisions)
    for (const Vector3& v : shape.mesh->vertices) all.extend(X_BL * v);
  for (const model::CollisionShape& shape : robot.description->links[link].collisions)
    for (const Vector3& v : shape.mesh->vertices)
      if ((X_BL * v).z() <= all.min().z() + height) lowest.extend(X_BL * v);
  return lowest;
}

/** Points along and across a sole that make so many. */
std::pair<int, int> soleGrid(int count) {
  const int along = count == 10 ? 5 : count == 50 ? 10 : static_cast<int>(std::lround(std::sqrt(count)));
  return {along, count / along};
}

}  // namespace

HuboStand::HuboStand(const HuboOptions& options)
    : options_(options), sim_(vector3(sharedYaml("worlds/hubo_plane.yaml")["simulation"]["gravity"]), options.settings) {
  const YAML::Node world = sharedYaml("worlds/hubo_plane.yaml");
  surface_ = footOnGround(world, options.compliant);
  sim::SurfaceLibrary surfaces;
  sim::RobotBuilder(huboConfig(world, options), sim::ContactConfig(), huboModel()).addTo(&sim_, &surfaces);
  if (options.sole_contacts > 0) {
    addSolePoints(0, options.sole_contacts / 2);
    addSolePoints(1, options.sole_contacts / 2);
  }
  if (options.link_corners) addLinkCorners();
  ground_ = std::numeric_limits<double>::infinity();
  for (const GroundPoint& point : points_)
    ground_ = std::min(ground_, (sim_.world.bodyState(point.body).X_WB * point.p_B).z() - options.drop);
  for (const int body : bodies()) weight_ -= sim_.world.bodySpec(body).inertial.mass * sim_.world.gravity().z();
  drives_.resize(sim_.world.jointCount());
}

void HuboStand::addSolePoints(int foot_index, int count) {
  const sim::RobotInfo& robot = sim_.robots[0];
  const int link = robot.description->linkIndex(foot_index == 0 ? "Body_LAR" : "Body_RAR");
  const int body = feet_[foot_index] = robot.bodies[robot.lumped->link_placement[link].body];
  const Box sole = linkBounds(robot, link, SOLE_THICKNESS);
  const double z = sole.min().z(), outer = foot_index == 0 ? sole.max().y() : sole.min().y();
  const std::uint64_t first_id = 1000000 * (foot_index + 1);
  if (count == 2) {
    points_.push_back({body, {sole.min().x(), outer, z}, first_id});
    points_.push_back({body, {sole.max().x(), outer, z}, first_id + 1});
    return;
  }
  const auto [along, across] = soleGrid(count);
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < across; ++k) {
      const double x = sole.min().x() + sole.sizes().x() * i / (along - 1), y = sole.min().y() + sole.sizes().y() * k / (across - 1);
      points_.push_back({body, {x, y, z}, first_id + across * i + k});
    }
}

void HuboStand::addLinkCorners() {
  const sim::RobotInfo& robot = sim_.robots[0];
  for (std::size_t link = 0; link < robot.description->links.size(); ++link) {
    const Box box = linkBounds(robot, static_cast<int>(link), std::numeric_limits<double>::infinity());
    if (box.isEmpty()) continue;
    const int body = robot.bodies[robot.lumped->link_placement[link].body];
    for (int i = 0; i < 8; ++i) points_.push_back({body, box.center() + dynamics::corner(box.sizes(), i), 8 * link + i + 1});
  }
}

void HuboStand::prepare() {
  contacts_.clear();
  for (const GroundPoint& point : points_) {
    const Vector3 p = sim_.world.bodyState(point.body).X_WB * point.p_B;
    const double gap = p.z() - ground_;
    if (gap < options_.margin)
      contacts_.push_back(dynamics::contactOf(point.body, dynamics::WORLD_BODY, p, Vector3::UnitZ(), -gap, surface_, point.id));
  }
  for (std::size_t j = 0; j < drives_.size(); ++j) {
    sim_.motors[j].sample(time(), DT);
    drives_[j] = sim_.motors[j].drive(sim_.world.jointState(static_cast<int>(j)));
  }
  ++steps_;
}

double HuboStand::follow(const std::string& motion) {
  const sim::JointTrajectory trajectory = motionWithRoot(motion);
  const sim::RobotInfo& robot = sim_.robots[0];
  for (std::size_t i = 0; i < trajectory.joints.size(); ++i) {
    const auto name = std::find(robot.joint_names.begin(), robot.joint_names.end(), trajectory.joints[i]);
    if (name == robot.joint_names.end()) continue;
    std::vector<sim::JointSpline::Knot> knots;
    for (const sim::TrajectoryPoint& point : trajectory.points)
      knots.push_back({time() + point.time_from_start, point.positions[i], 0, 0, 0, 1});
    const int joint = robot.joints[name - robot.joint_names.begin()];
    sim_.motors[joint].follow(time(), time(), knots, sim_.world.jointState(joint).position);
  }
  return trajectory.points.back().time_from_start;
}

void HuboStand::copyState(const HuboStand& other) {
  for (int b = 0; b < sim_.world.bodyCount(); ++b) sim_.world.setBodyState(b, other.world().bodyState(b));
  for (int j = 0; j < sim_.world.jointCount(); ++j) sim_.world.resetJointPosition(j, other.world().jointState(j).position);
  sim_.motors = other.sim_.motors;
  steps_ = other.steps_;
}

double HuboStand::groundForce(const dynamics::SolveResult& result, int body) const {
  double sum = 0;
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    if (body == dynamics::WORLD_BODY || contacts_[i].body_a == body) sum += result.contact_forces[i].z();
  return sum;
}

}  // namespace blem_sim
