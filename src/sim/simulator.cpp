#include "blem_sim/sim/simulator.h"

#include <fmt/format.h>

#include <algorithm>

#include "blem_sim/geometry/input_error.h"
#include "config/config_check.h"
#include "numbers/nearest_name.h"
#include "simulator_impl.h"

namespace blem_sim::sim {
namespace {

template <typename Named>
int indexOf(const std::vector<Named>& items, const std::string& name) {
  const auto at = std::find_if(items.begin(), items.end(), [&](const Named& item) { return item.name == name; });
  return at == items.end() ? -1 : static_cast<int>(at - items.begin());
}

}  // namespace

Simulator::Impl::Impl(const SimulationConfig& config, const model::UriResolver& resolver, LoadLog log, const Impl* loaded)
    : config_((checkConfig(config), config)),
      world_(config.gravity, config.solver),
      builder_(config.contact, config.time_step, config.base_directory, resolver, std::move(log)),
      threads_(config.solver.threads),
      pair_watch_(&threads_),
      pair_searches_(&threads_),
      constraint_maker_(config.contact, &threads_),
      sweep_guard_(&threads_),
      energy_balance_(config.solver) {
  if (loaded) builder_.learnFrom(loaded->builder_);
  for (const EnvironmentConfig& environment : config_.environments) {
    builder_.addEnvironment(environment, &world_);
    addLive(environment);
  }
  for (const RobotConfig& robot : config_.robots) builder_.addRobot(robot, &world_);
  for (const ObjectConfig& object : config_.objects) builder_.addObject(object, &world_);
  sensors_.make(world_, config_.time_step, config_.random_seed);
  reportWithoutStep();
}

void Simulator::Impl::unloadEnvironment(const std::string& name) {
  std::vector<std::string> environments;
  for (const ModelInfo& model : world_.models)
    if (model.alive && model.kind == ModelKind::ENVIRONMENT) environments.push_back(model.name);
  requireName(name, environments, "unload_environment", "environment");
  removeModel(name);
}

void Simulator::Impl::loadEnvironment(const EnvironmentConfig& environment) {
  checkEnvironment(environment);
  builder_.addEnvironment(environment, &world_);
  addLive(environment);
  forgetLayers(environment.name);
}

void Simulator::Impl::forgetLayers(const std::string& model) {
  // The next step tells that pairs of the slots' earlier colliders are gone, unless the slots are taken by then, as here.
  for (const int collider : world_.collidersOf(world_.modelIndex(model))) layer_watch_.forget(collider);
  at_hand_.known = false;
  layout_.clear();
}

Simulator::Simulator(const SimulationConfig& config, const model::UriResolver& resolver, LoadLog log, const Simulator* loaded)
    : impl_(std::make_unique<Impl>(config, resolver, std::move(log), loaded ? loaded->impl_.get() : nullptr)) {}
Simulator::~Simulator() = default;

void Simulator::watch(SimulatorWatcher* watcher) { impl_->watcher_ = watcher; }

const StepReport& Simulator::step() {
  const StepReport& report = impl_->step();
  if (impl_->watcher_) impl_->watcher_->stepped();
  return report;
}

const StepReport& Simulator::report() const { return impl_->report_; }
double Simulator::time() const { return impl_->time(); }
std::uint64_t Simulator::steps() const { return impl_->step_count_; }
const SimulationConfig& Simulator::config() const { return impl_->config_; }
const Vector3& Simulator::gravity() const { return impl_->world_.world.gravity(); }

const std::vector<ModelInfo>& Simulator::models() const { return impl_->world_.models; }
const std::vector<RobotInfo>& Simulator::robots() const { return impl_->world_.robots; }
const std::vector<SensorInfo>& Simulator::sensors() const { return impl_->world_.sensors; }
const std::vector<contact::Collider>& Simulator::colliders() const { return impl_->world_.colliders; }
const std::vector<geometry::MeshReport>& Simulator::loadReport() const { return impl_->world_.load_report; }
const std::vector<std::string>& Simulator::notes() const { return impl_->world_.notes; }
const dynamics::World& Simulator::world() const { return impl_->world_.world; }

std::string Simulator::bodyName(int body) const { return body == dynamics::WORLD_BODY ? "world" : world().bodySpec(body).name; }
int Simulator::robotIndex(const std::string& name) const { return indexOf(robots(), name); }
int Simulator::modelIndex(const std::string& name) const { return impl_->world_.modelIndex(name); }
Pose Simulator::linkPose(int robot, int link) const { return impl_->world_.linkPose(robots().at(robot), link); }

void Simulator::commandTrajectory(int robot, const JointTrajectory& trajectory) {
  impl_->commandTrajectory(robot, trajectory);
  impl_->tell("commandTrajectory", robot, trajectory);
}
void Simulator::commandJoints(int robot, const JointCommandMessage& command) {
  impl_->commandJoints(robot, command);
  impl_->tell("commandJoints", robot, command);
}
void Simulator::driveJoints(int robot, const JointVelocityCommand& command) {
  impl_->driveJoints(robot, command);
  impl_->tell("driveJoints", robot, command);
}
void Simulator::driveBase(int robot, int link, const BaseVelocityCommand& command) {
  impl_->driveBase(robot, link, command);
  impl_->tell("driveBase", robot, link, command);
}
void Simulator::releaseBase(int robot) {
  impl_->releaseBase(robot);
  impl_->tell("releaseBase", robot);
}
void Simulator::checkBase(int robot) const { impl_->checkBase(robot); }
const BaseVelocityCommand* Simulator::baseCommand(int robot) const { return impl_->base_drives_.commandOf(robots().at(robot).bodies[0]); }
void Simulator::checkJointCommand(int robot, const JointCommandMessage& command) const { impl_->checkJointCommand(robot, command); }
JointSample Simulator::desiredState(int robot, int joint) const { return desiredState(robot, joint, time()); }
JointSample Simulator::desiredState(int robot, int joint, double time) const {
  return impl_->desiredState(robots().at(robot).joints.at(joint), time);
}

const JointSpline* Simulator::followedPath(int robot, int joint) const {
  const JointMotor& motor = impl_->world_.motors[robots().at(robot).joints.at(joint)];
  return motor.settings().commanded ? motor.path() : nullptr;
}

void Simulator::holdJoints(int robot, const std::vector<int>& joints) {
  for (const int joint : joints) holdJoint(robot, joint, world().jointState(robots().at(robot).joints.at(joint)).position);
}

void Simulator::holdJoint(int robot, int joint, double position) {
  const int world_joint = robots().at(robot).joints.at(joint);
  impl_->world_.motors[world_joint].hold(impl_->nearestTurn(world_joint, position));
  impl_->tell("holdJoint", robot, joint, position);
}

void Simulator::loadEnvironment(const EnvironmentConfig& environment) {
  impl_->loadEnvironment(environment);
  impl_->tell("loadEnvironment", environment);
}
void Simulator::unloadEnvironment(const std::string& name) {
  impl_->unloadEnvironment(name);
  impl_->tell("unloadEnvironment", name);
}

CloudNeighbours Simulator::cloudNeighbours(const std::string& environment) const { return impl_->cloudNeighbours(environment); }

void Simulator::updateCloud(const std::string& environment, CloudSurface* surface, std::vector<SearchedAhead> ahead) {
  const CloudSurface taken = *surface;
  impl_->updateCloud(environment, surface, &ahead);
  impl_->tell("updateCloud", environment, taken);
}

void Simulator::spawn(const RobotConfig& robot) {
  impl_->spawn(robot);
  impl_->tell("spawn", robot);
}
void Simulator::removeModel(const std::string& name) {
  impl_->removeModel(name);
  impl_->tell("removeModel", name);
}
void Simulator::restrictFiles(const model::FileRoots& roots) { impl_->builder_.restrictFiles(roots); }

void Simulator::attach(const std::string& object, const LinkPart& part, double max_force, double max_torque) {
  impl_->attach(object, part, max_force, max_torque);
  impl_->tell("attach", object, part.name, max_force, max_torque);
}
void Simulator::detach(const std::string& object) {
  impl_->detach(object);
  impl_->tell("detach", object);
}
const std::vector<AttachedModel>& Simulator::attachments() const { return impl_->world_.attachments; }

void Simulator::moveModel(int body, const dynamics::BodyState& to) {
  impl_->moveModel(body, to);
  impl_->tell("moveModel", body, to);
}
void Simulator::setJointPositions(int robot, const std::vector<std::string>& joints, const std::vector<double>& positions) {
  impl_->setJointPositions(robot, joints, positions);
  impl_->tell("setJointPositions", robot, joints, positions);
}
void Simulator::resetModel(int model) {
  impl_->resetModel(model);
  impl_->tell("resetModel", model);
}

void Simulator::applyLoad(const BodyLoad& load, const LoadTime& when) {
  impl_->loads_.apply(load, when, {time(), config().time_step});
  impl_->tell("applyLoad", load.body, load, when);
}
void Simulator::applyEffort(int joint, double effort, const LoadTime& when) {
  impl_->loads_.apply(joint, effort, when, {time(), config().time_step});
  impl_->tell("applyEffort", joint, effort, when);
}
void Simulator::clearLoads(int body) {
  impl_->loads_.clearBody(body);
  impl_->tell("clearLoads", body);
}
void Simulator::clearEfforts(int joint) {
  impl_->loads_.clearJoint(joint);
  impl_->tell("clearEfforts", joint);
}

void Simulator::tareSensor(int sensor) {
  const SensorConfig& config = sensors().at(static_cast<std::size_t>(sensor)).config;
  if (config.type != SensorType::FORCE_TORQUE)
    throw InputError(fmt::format("sensor '{}' has no zero to be set; tare one of type force_torque", config.name));
  impl_->sensors_.tare(sensor).ask();
  impl_->tell("tareSensor", sensor);
}

void Simulator::setPhysics(const Vector3& gravity, double time_step, double real_time_factor) {
  impl_->setPhysics(gravity, time_step, real_time_factor);
  impl_->tell("setPhysics", gravity, time_step, real_time_factor);
}
void Simulator::setLinkInertial(int body, int link, const geometry::MassProperties& inertial) {
  impl_->setLinkInertial(body, link, inertial);
  impl_->tell("setLinkInertial", body, impl_->isOfRobot(body) ? link : -1, inertial);
}
void Simulator::setLinkGravity(int body, int link, bool acts) {
  impl_->setLinkGravity(body, link, acts);
  impl_->tell("setLinkGravity", body, impl_->isOfRobot(body) ? link : -1, acts);
}
void Simulator::setJointLimits(int robot, int joint, double lower, double upper) {
  impl_->setJointLimits(robot, joint, lower, upper);
  impl_->tell("setJointLimits", robot, joint, lower, upper);
}

}  // namespace blem_sim::sim
