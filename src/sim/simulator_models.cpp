// Models that come and go between steps, and their properties.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>

#include "blem_sim/geometry/input_error.h"
#include "build/joint_loads.h"
#include "build/robot_builder.h"
#include "config/config_check.h"
#include "config/scene_limits.h"
#include "gazebo/gazebo_robot.h"
#include "numbers/nearest_name.h"
#include "simulator_impl.h"

namespace blem_sim::sim {
namespace {

constexpr double SHORTEST_STEP = 1e-6, LONGEST_STEP = 0.1;  // [s]
constexpr double AT_LIMIT = 1e-6;                           // [rad or m] by which a joint that rests on a limit may be beyond it

ObjectConfig objectOf(const RobotConfig& robot) {
  ObjectConfig object;
  object.name = robot.name;
  object.urdf = robot.urdf;
  object.urdf_xml = robot.urdf_xml;
  object.X_WO = robot.X_WR;
  object.contact = robot.contact;
  object.max_contacts = robot.max_contacts;
  return object;
}

void checkName(const std::string& name) {
  if (name.find("::") != std::string::npos)
    throw InputError(fmt::format("'{}': the name has ::, which stands between model and link; leave it out", name));
}

std::set<std::string> keptJoints(const SimulatedWorld& world, int robot) {
  std::set<std::string> joints;
  for (const SensorInfo& sensor : world.sensors)
    if (sensor.robot == robot && sensor.config.type == SensorType::FORCE_TORQUE) joints.insert(sensor.config.joint);
  return joints;
}

/** @throws InputError: the robot has no link of that index */
void requireLink(const RobotInfo& robot, int link) {
  const int links = static_cast<int>(robot.description->links.size());
  if (link < 0 || link >= links) throw InputError(fmt::format("'{}': has no link {}; its links are 0 to {}", robot.name, link, links - 1));
}

/** Tells motors what their efforts meet now that links weigh otherwise. */
void weighLoads(const RobotInfo& robot, SimulatedWorld* world) {
  const auto jointOf = [&](std::size_t j) { return robot.world_joints[j]; };
  std::vector<double> positions(robot.world_joints.size(), 0);
  for (std::size_t j = 0; j < positions.size(); ++j)
    if (jointOf(j) >= 0) positions[j] = world->start_positions[jointOf(j)];
  std::vector<JointLoad> loads = jointLoads(*robot.lumped, positions, robot.fixed_base, 0);
  for (std::size_t j = 0; j < loads.size(); ++j) {
    if (!robot.lumped->joints[j].moves()) continue;
    loads[j].child.inertia += world->world.jointSpec(jointOf(j)).armature;
    world->motors[jointOf(j)].setInertia(lightInertia(loads[j]));
  }
}

}  // namespace

void Simulator::Impl::spawn(RobotConfig robot) {
  checkName(robot.name);
  checkRobot(robot);
  world_.checkNewName(robot.name, "robots");
  if (static_cast<std::size_t>(std::count_if(world_.models.begin(), world_.models.end(), [](const ModelInfo& m) { return m.alive; })) >=
      MOST_MODELS)
    throw InputError(fmt::format("{}: there are {} models, which is the most; delete some", robot.name, MOST_MODELS));
  const std::shared_ptr<const model::RobotModel> model = builder_.describe(robot);
  robot.fixed_base = robot.fixed_base || model->links[model->root].name == WORLD_LINK;
  const RobotConfig whole = withGazeboBlocks(robot, *model).config;
  const bool one_free_body =
      !robot.fixed_base && whole.sensors.empty() && whole.drives.empty() && model::lumpFixedJoints(*model, {}, false).bodies.size() == 1;
  if (one_free_body)
    builder_.addObject(objectOf(robot), &world_);
  else
    builder_.addRobot(robot, &world_);
  report_.samples.clear();
  sensors_.make(world_, config_.time_step, config_.random_seed);
  forgetLayers(robot.name);
  reportWithoutStep();
}

void Simulator::Impl::removeModel(const std::string& name) {
  requireName(name, modelNames(world_.models), "model_name", "model");
  const int model = world_.modelIndex(name);
  detachAll(model);
  if (world_.robotOf(model) >= 0) {
    report_.samples.clear();
    sensors_.removeOf(world_, world_.robotOf(model));
  }
  const std::vector<int> bodies = world_.models[model].bodies;
  for (const int body : bodies) {
    loads_.clearBody(body);
    base_drives_.clearBody(body);
  }
  for (int joint = 0; joint < world_.world.jointCount(); ++joint) {
    const dynamics::JointSpec& spec = world_.world.jointSpec(joint);
    if (std::find(bodies.begin(), bodies.end(), spec.child) != bodies.end()) loads_.clearJoint(joint);
  }
  forgetContacts(world_.collidersOf(model));
  world_.removeModel(name);
  live_.erase(name);
  memories_.erase(name);
  layout_.clear();
  reportWithoutStep();
}

void Simulator::Impl::forgetContacts(const std::vector<int>& colliders) { world_.world.forgetContacts(forgetPairs(colliders)); }

std::vector<std::uint64_t> Simulator::Impl::forgetPairs(const std::vector<int>& colliders) {
  std::vector<std::uint64_t> ids;
  for (const int collider : colliders) {
    const std::vector<std::uint64_t> gone = constraint_maker_.forget(collider);
    ids.insert(ids.end(), gone.begin(), gone.end());
    pair_searches_.forget(collider);
    at_hand_.crossings.forget(collider);
    fading_.forget(collider);
  }
  pair_watch_.forget();
  at_hand_.known = false;
  return ids;
}

void Simulator::Impl::requireAlive(int model) const {
  if (model < 0 || model >= static_cast<int>(world_.models.size()) || !world_.models[model].alive)
    throw InputError(fmt::format("model {}: there is none in this slot; take the index of one that is alive", model));
}

void Simulator::Impl::setLinkInertial(int body, int link, const geometry::MassProperties& inertial) {
  const int model = modelOfBody(body), index = world_.robotOf(model);
  if (index < 0) {
    world_.world.setInertial(body, inertial);
  } else {
    RobotInfo& robot = world_.robots[index];
    requireLink(robot, link);
    const auto description = std::make_shared<model::RobotModel>(*robot.description);
    description->links[link].inertial = inertial;
    const auto lumped =
        std::make_shared<const model::LumpedRobot>(model::lumpFixedJoints(*description, keptJoints(world_, index), robot.fixed_base));
    world_.world.setInertial(body, lumped->bodies[robot.lumped->link_placement[link].body].inertial);
    robot.description = description;
    robot.lumped = lumped;
    weighLoads(robot, &world_);
    sensors_.remake(world_, config_.time_step);
  }
  forgetContacts(world_.collidersOf(model));
  layout_.clear();
  reportWithoutStep();
}

void Simulator::Impl::setLinkGravity(int body, int link, bool acts) {
  const int model = modelOfBody(body), robot = world_.robotOf(model);
  if (robot >= 0) requireLink(world_.robots[robot], link);
  const WeightlessPart part{body, robot >= 0 ? link : -1};
  if (acts)
    world_.models[model].weightless.erase(part);
  else
    world_.models[model].weightless.insert(part);
  layout_.clear();
  reportWithoutStep();
}

geometry::MassProperties Simulator::Impl::linkInertial(int body, int link) const {
  const int robot = link < 0 ? -1 : world_.robotOf(modelOfBody(body));
  if (robot < 0) return world_.world.bodySpec(body).inertial;
  const RobotInfo& info = world_.robots[robot];
  const model::LumpedBody& lumped = info.lumped->bodies[info.lumped->link_placement[link].body];
  const std::optional<model::Inertial>& own = info.description->links[link].inertial;
  if (own) return *own;
  return lumped.links.size() == 1 ? lumped.inertial : geometry::MassProperties();
}

geometry::MassProperties Simulator::linkInertial(int body, int link) const { return impl_->linkInertial(body, link); }

void Simulator::Impl::setJointLimits(int robot, int joint, double lower, double upper) {
  RobotInfo& info = world_.robots.at(robot);
  const std::string where = fmt::format("joint '{}': ", info.joint_names.at(joint));
  const int world_joint = info.joints[joint];
  if (world_.motors[world_joint].settings().continuous) throw InputError(where + "turns without end and takes no limits");
  if (!(lower <= upper)) throw InputError(fmt::format("{}loStop {:g} and hiStop {:g}: the lower comes first", where, lower, upper));
  const double position = world_.world.jointState(world_joint).position;
  if (!(lower - AT_LIMIT <= position && position <= upper + AT_LIMIT))
    throw InputError(fmt::format("{}stands at {:.6g}, which is not from {:g} to {:g}; move it there first", where, position, lower, upper));
  world_.world.setJointLimits(world_joint, lower, upper);
  info.limits[joint].lower = lower;
  info.limits[joint].upper = upper;
  layout_.clear();
}

void Simulator::setJointDamping(int robot, int joint, double damping) {
  const std::string& name = robots().at(robot).joint_names.at(joint);
  if (!(damping >= 0) || !isCommand(damping))
    throw InputError(fmt::format("joint '{}': damping: is {:g}; give it a finite number of at least 0", name, damping));
  impl_->world_.motors[robots()[robot].joints[joint]].setViscousFriction(damping);
  impl_->layout_.clear();
  impl_->tell("setJointDamping", robot, joint, damping);
}

double Simulator::jointDamping(int world_joint) const { return impl_->world_.motors.at(world_joint).settings().friction.viscous; }

void Simulator::setMotorGains(int robot, int joint, const JointGains& gains) {
  const std::string where = fmt::format("joint '{}': ", robots().at(robot).joint_names.at(joint));
  JointMotor& motor = impl_->world_.motors[robots()[robot].joints[joint]];
  if (!motor.settings().commanded) throw InputError(where + "has no motor of its own; set the gains of the one that it follows");
  for (const double gain : {gains.p, gains.i, gains.d})
    if (!(gain >= 0) || !isCommand(gain))
      throw InputError(fmt::format("{}a gain is {:g}; give it a finite number of at least 0", where, gain));
  if (!(gains.i_clamp >= 0)) throw InputError(where + "i_clamp: needs a number of at least 0");
  motor.setGains(gains);
  impl_->layout_.clear();
  impl_->tell("setMotorGains", robot, joint, gains);
}

JointGains Simulator::motorGains(int robot, int joint) const {
  return impl_->world_.motors.at(robots().at(robot).joints.at(joint)).settings().gains;
}

void Simulator::setFriction(int model, double friction) {
  impl_->requireAlive(model);
  const std::string& name = models().at(model).name;
  if (!(friction >= 0) || !isCommand(friction))
    throw InputError(fmt::format("'{}': friction: is {:g}; give it a finite number of at least 0", name, friction));
  for (const int collider : impl_->world_.collidersOf(model)) impl_->world_.colliders[collider].surface.friction = friction;
  const auto live = impl_->live_.find(name);
  if (live != impl_->live_.end()) live->second.surface.friction = friction;
  impl_->layout_.clear();
  impl_->tell("setFriction", model, friction);
}

double Simulator::friction(int model) const {
  const auto live = impl_->live_.find(models().at(model).name);
  if (live != impl_->live_.end()) return live->second.surface.friction;
  const std::vector<int> colliders = impl_->world_.collidersOf(model);
  return colliders.empty() ? 0 : impl_->world_.colliders[colliders.front()].surface.friction;
}

void Simulator::Impl::setPhysics(const Vector3& gravity, double time_step, double real_time_factor) {
  if (!(time_step >= SHORTEST_STEP && time_step <= LONGEST_STEP))
    throw InputError(fmt::format("time_step: is {:g}; give it {:g} to {:g} s", time_step, SHORTEST_STEP, LONGEST_STEP));
  if (!(gravity.array().abs() <= LARGEST_GRAVITY).all())
    throw InputError(fmt::format("gravity: needs three numbers, not beyond {:g} m/s^2", LARGEST_GRAVITY));
  if (!(real_time_factor >= 0) || !std::isfinite(real_time_factor))
    throw InputError("max_update_rate: needs a finite number of at least 0");
  world_.world.setGravity(gravity);
  config_.gravity = gravity;
  config_.real_time_factor = real_time_factor;
  at_hand_.known = false;  // contacts with what fades depend on the way up
  if (time_step == config_.time_step) return;
  epoch_ = {time(), step_count_};
  config_.time_step = time_step;
  builder_.setTimeStep(time_step);
  layout_.clear();
  sensors_.remake(world_, config_.time_step);
}

}  // namespace blem_sim::sim
