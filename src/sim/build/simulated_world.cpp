#include "build/simulated_world.h"

#include <fmt/format.h>

#include <algorithm>

#include "blem_sim/geometry/free_slots.h"
#include "blem_sim/geometry/input_error.h"

namespace blem_sim {

void SimulatedWorld::checkNewName(const std::string& name, const std::string& section) const {
  if (name.empty()) throw InputError(fmt::format("{}: an entry has no name; give it one", section));
  if (modelIndex(name) >= 0)
    throw InputError(fmt::format("{}: {}: the name is taken; every environment, robot and object needs its own", section, name));
}

int SimulatedWorld::addModel(const std::string& name, ModelKind kind, int max_contacts) {
  ModelInfo model;
  model.name = name;
  model.kind = kind;
  const int index = takeSlot(&free_models_, &models);
  budgets.resize(models.size());
  models[index] = model;
  budgets[index] = {max_contacts};
  model_named_[name] = index;
  return index;
}

int SimulatedWorld::addCollider(Collider collider, double width, const SurfaceProperties& surface, MeshReport report) {
  collider.radius = width;
  collider.surface = surface;
  report.name = collider.name;
  report.boundary_width = width;
  report.bytes = collider.geometry->bytes();
  load_report.push_back(std::move(report));
  const int index = takeSlot(&free_colliders_, &colliders);
  colliders[index] = std::move(collider);
  return index;
}

std::vector<int> SimulatedWorld::removeEnvironment(const std::string& name) {
  const int model = modelIndex(name);
  models[model].alive = false;
  model_named_.erase(name);
  free_models_.insert(model);
  std::vector<int> removed;
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    if (!colliders[i].enabled || colliders[i].model != model) continue;
    colliders[i].enabled = false;
    colliders[i].geometry.reset();
    free_colliders_.insert(static_cast<int>(i));
    removed.push_back(static_cast<int>(i));
  }
  const auto is_its = [&](const MeshReport& report) { return report.name == name; };
  load_report.erase(std::remove_if(load_report.begin(), load_report.end(), is_its), load_report.end());
  return removed;
}

int SimulatedWorld::modelIndex(const std::string& name) const {
  const auto known = model_named_.find(name);
  return known != model_named_.end() ? known->second : -1;
}

Pose SimulatedWorld::linkPose(const RobotInfo& robot, int link) const {
  const LinkPlacement& placement = robot.lumped->link_placement[link];
  const int body = robot.bodies[placement.body];
  return (body == WORLD_BODY ? robot.X_WR : world.bodyState(body).X_WB) * placement.X_BL;
}

Pose SimulatedWorld::linkPose(const RobotInfo& robot, int link, const std::vector<BodyState>& bodies) const {
  const LinkPlacement& placement = robot.lumped->link_placement[link];
  const int body = robot.bodies[placement.body];
  return (body == WORLD_BODY ? robot.X_WR : bodies[body].X_WB) * placement.X_BL;
}

Vector3 SimulatedWorld::linkOrigin(const Collider& collider, const std::vector<BodyState>& bodies) const {
  if (collider.body == WORLD_BODY) return Vector3::Zero();
  if (collider.link < 0) return bodies[collider.body].X_WB.translation();
  // Robots come in the order of their models.
  const auto robot =
      std::partition_point(robots.begin(), robots.end(), [&](const RobotInfo& other) { return other.model < collider.model; });
  return linkPose(*robot, collider.link, bodies).translation();
}

void SimulatedWorld::bodyStates(std::vector<BodyState>* out) const {
  out->resize(world.bodyCount());
  for (int body = 0; body < world.bodyCount(); ++body) (*out)[body] = world.bodyState(body);
}

}  // namespace blem_sim
