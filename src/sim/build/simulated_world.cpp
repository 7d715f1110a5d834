#include "build/simulated_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "blem_sim/geometry/free_slots.h"
#include "blem_sim/geometry/input_error.h"

namespace blem_sim::sim {
namespace {

constexpr double EARTHS_GRAVITY = 9.81;  // [m/s^2]

}  // namespace

void SimulatedWorld::checkNewName(const std::string& name, const std::string& section) const {
  if (name.empty()) throw InputError(fmt::format("{}: an entry has no name; give it one", section));
  if (modelIndex(name) >= 0)
    throw InputError(fmt::format("{}: {}: the name is taken; every environment, robot and object needs its own", section, name));
}

int SimulatedWorld::addModel(const std::string& name, ModelKind kind, int max_contacts) {
  ModelInfo model;
  model.name = name;
  model.kind = kind;
  const int index = geometry::takeSlot(&free_models_, &models);
  budgets.resize(models.size());
  models[index] = model;
  budgets[index] = {max_contacts};
  model_named_[name] = index;
  return index;
}

int SimulatedWorld::addCollider(contact::Collider collider, double width, const contact::SurfaceProperties& surface,
                                geometry::MeshReport report) {
  collider.radius = width;
  collider.surface = surface;
  report.name = collider.name;
  report.boundary_width = width;
  report.bytes = collider.geometry->bytes() + (collider.outside ? collider.outside->bytes() : 0);
  load_report.push_back(std::move(report));
  const int index = geometry::takeSlot(&free_colliders_, &colliders);
  colliders[index] = std::move(collider);
  return index;
}

int SimulatedWorld::addBody(const dynamics::BodySpec& spec, const Vector3& v_WCom, const Vector3& w_WB) {
  const int body = world.addBody(spec);
  const dynamics::BodyState state{spec.X_WB, v_WCom, w_WB};
  world.setBodyState(body, state);
  start_states.resize(world.bodyCount());
  start_states[body] = state;
  return body;
}

int SimulatedWorld::addJoint(const dynamics::JointSpec& spec, double position, const JointMotor& motor) {
  const int joint = world.addJoint(spec, position);
  motors.resize(world.jointCount());
  start_positions.resize(world.jointCount());
  motors[joint] = motor;
  start_positions[joint] = position;
  return joint;
}

void SimulatedWorld::removeJoint(int joint) {
  world.removeJoint(joint);
  motors[joint] = JointMotor();
  start_positions[joint] = 0;
}

int SimulatedWorld::addRobot(const RobotInfo& robot) {
  const auto behind =
      std::upper_bound(robots.begin(), robots.end(), robot.model, [](int model, const RobotInfo& other) { return model < other.model; });
  const int index = static_cast<int>(behind - robots.begin());
  robots.insert(behind, robot);
  for (SensorInfo& sensor : sensors)
    if (sensor.robot >= index) ++sensor.robot;
  return index;
}

std::vector<int> SimulatedWorld::removeModel(const std::string& name) {
  const int model = modelIndex(name);
  std::vector<int> removed = collidersOf(model);
  removeColliders(removed);
  removeBodies(models[model]);
  if (robotOf(model) >= 0) removeRobot(robotOf(model));
  removeReports(name);
  filter.setSelfCollision(model, false);
  models[model] = ModelInfo();
  models[model].alive = false;
  model_named_.erase(name);
  free_models_.insert(model);
  return removed;
}

std::vector<int> SimulatedWorld::removeShapes(int model) {
  std::vector<int> removed = collidersOf(model);
  removeReports(models[model].name);
  removeColliders(removed);
  return removed;
}

void SimulatedWorld::removeShape(int collider) {
  removeReports(colliders[collider].name);
  removeColliders({collider});
}

/** @param removed ascending */
void SimulatedWorld::removeColliders(const std::vector<int>& removed) {
  for (const int collider : removed) {
    colliders[collider].enabled = false;
    colliders[collider].geometry.reset();
    colliders[collider].outside.reset();
    free_colliders_.insert(collider);
  }
  const auto is_removed = [&](int collider) { return std::binary_search(removed.begin(), removed.end(), collider); };
  for (auto pair = disabled_pairs.begin(); pair != disabled_pairs.end();)
    pair = is_removed(pair->first) || is_removed(pair->second) ? disabled_pairs.erase(pair) : std::next(pair);
}

void SimulatedWorld::removeBodies(const ModelInfo& model) {
  for (const int body : model.bodies) {
    filter.forgetBody(body);
    world.removeBody(body);
    start_states[body] = dynamics::BodyState();
  }
  for (int joint = 0; joint < world.jointCount(); ++joint) {
    if (world.hasJoint(joint)) continue;
    motors[joint] = JointMotor();
    start_positions[joint] = 0;
  }
}

void SimulatedWorld::removeRobot(int robot) {
  robots.erase(robots.begin() + robot);
  sensors.erase(std::remove_if(sensors.begin(), sensors.end(), [robot](const SensorInfo& sensor) { return sensor.robot == robot; }),
                sensors.end());
  for (SensorInfo& sensor : sensors)
    if (sensor.robot > robot) --sensor.robot;
}

void SimulatedWorld::removeReports(const std::string& name) {
  const auto begins = [](const std::string& text, const std::string& start) { return text.compare(0, start.size(), start) == 0; };
  const auto is_its = [&](const geometry::MeshReport& report) { return report.name == name || begins(report.name, name + "::"); };
  load_report.erase(std::remove_if(load_report.begin(), load_report.end(), is_its), load_report.end());
  notes.erase(std::remove_if(notes.begin(), notes.end(), [&](const std::string& note) { return begins(note, name + ": "); }), notes.end());
}

int SimulatedWorld::robotOf(int model) const {
  const auto robot = std::partition_point(robots.begin(), robots.end(), [&](const RobotInfo& other) { return other.model < model; });
  return robot != robots.end() && robot->model == model ? static_cast<int>(robot - robots.begin()) : -1;
}

std::vector<int> SimulatedWorld::collidersOf(int model) const {
  std::vector<int> found;
  for (std::size_t i = 0; i < colliders.size(); ++i)
    if (colliders[i].enabled && colliders[i].model == model) found.push_back(static_cast<int>(i));
  return found;
}

int SimulatedWorld::modelIndex(const std::string& name) const {
  const auto known = model_named_.find(name);
  return known != model_named_.end() ? known->second : -1;
}

Pose SimulatedWorld::linkPose(const RobotInfo& robot, int link) const {
  const model::LinkPlacement& placement = robot.lumped->link_placement[link];
  const int body = robot.bodies[placement.body];
  return (body == dynamics::WORLD_BODY ? robot.X_WR : world.bodyState(body).X_WB) * placement.X_BL;
}

Pose SimulatedWorld::linkPose(const RobotInfo& robot, int link, const std::vector<dynamics::BodyState>& bodies) const {
  const model::LinkPlacement& placement = robot.lumped->link_placement[link];
  const int body = robot.bodies[placement.body];
  return (body == dynamics::WORLD_BODY ? robot.X_WR : bodies[body].X_WB) * placement.X_BL;
}

Vector3 SimulatedWorld::linkOrigin(const contact::Collider& collider, const std::vector<dynamics::BodyState>& bodies) const {
  if (collider.body == dynamics::WORLD_BODY) return Vector3::Zero();
  if (collider.link < 0) return bodies[collider.body].X_WB.translation();
  return linkPose(robots[robotOf(collider.model)], collider.link, bodies).translation();
}

double SimulatedWorld::gravityToHold() const { return std::max(EARTHS_GRAVITY, world.gravity().norm()); }

void SimulatedWorld::bodyStates(std::vector<dynamics::BodyState>* out) const {
  out->resize(world.bodyCount());
  for (int body = 0; body < world.bodyCount(); ++body) (*out)[body] = world.bodyState(body);
}

std::vector<std::string> modelNames(const std::vector<ModelInfo>& models) {
  std::vector<std::string> names;
  for (const ModelInfo& model : models)
    if (model.alive) names.push_back(model.name);
  return names;
}

}  // namespace blem_sim::sim
