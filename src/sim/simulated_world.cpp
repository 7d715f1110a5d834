#include "simulated_world.h"

#include <fmt/format.h>

#include <algorithm>

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
  models.push_back(model);
  budgets.push_back({max_contacts});
  const int index = static_cast<int>(models.size()) - 1;
  model_named_[name] = index;
  return index;
}

void SimulatedWorld::addCollider(Collider collider, double width, const SurfaceProperties& surface, MeshReport report) {
  collider.radius = width;
  collider.surface = surface;
  report.name = collider.name;
  report.boundary_width = width;
  report.bytes = collider.geometry->bytes();
  load_report.push_back(std::move(report));
  colliders.push_back(std::move(collider));
}

int SimulatedWorld::modelIndex(const std::string& name) const {
  const auto known = model_named_.find(name);
  return known != model_named_.end() && models[known->second].alive ? known->second : -1;
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
