// Colliders of a robot, and the pairs of them that never touch.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "build/contact_settings.h"
#include "build/robot_builder.h"

namespace blem_sim::sim {
namespace {

constexpr double CROSSED = 0.1;  // of the layers: what crosses by less, as fingers that are closed, contacts part

}  // namespace

void RobotBuilder::addColliders(SurfaceLibrary* surfaces) {
  double mass = 0;
  for (const model::LumpedBody& body : lumped_->bodies) mass += body.inertial.mass;
  const WidthNeeds needs = needsOfLink(mass * world_->world.gravity().norm());
  for (std::size_t link = 0; link < model_->links.size(); ++link) {
    const model::LinkModel& description = model_->links[link];
    const ContactSettings of_link = contactSettings(
        contact_.boundary_width, contact_,
        {overridesOf(config_.described_links, description.name), &config_.contact, overridesOf(config_.links, description.name)});
    const model::LinkPlacement& placement = lumped_->link_placement[link];
    const int body = info_.bodies[placement.body];
    for (const model::CollisionShape& shape : description.collisions) {
      contact::Collider collider;
      collider.name = config_.name + "::" + description.name;
      collider.body = body;
      collider.model = info_.model;
      collider.link = static_cast<int>(link);
      collider.X_BC = body == dynamics::WORLD_BODY ? config_.X_WR * placement.X_BL : placement.X_BL;
      geometry::MeshReport report = shape.report;
      ContactSettings settings = of_link;
      const auto geometry = surfaces->geometry(shape.mesh);
      surfaces->chooseWidth(*geometry, needs, shape.radius, &settings, &report);
      collider.geometry = surfaces->fitted(geometry, settings, shape.radius, &report);
      world_->addCollider(collider, shape.radius > 0 ? shape.radius : settings.boundary_width.metres, settings.surface, report);
    }
  }
}

// Bodies joined by a joint never touch; the bodies inside a planar joint have no links and are seen through. Bodies that a joint kept for a
// sensor holds together count as the one they would be without it.
void RobotBuilder::disableNeighbours() {
  const int count = static_cast<int>(lumped_->bodies.size());
  std::vector<int> parent(count, -1), rigid(count, 0);  // rigid: first of the bodies that are held together
  for (const model::LumpedJoint& joint : lumped_->joints) {
    parent[joint.child] = joint.parent;
    rigid[joint.child] = joint.type == model::JointType::FIXED ? rigid[joint.parent] : joint.child;
  }
  const auto above = [&](int first) {
    int p = parent[first];
    while (p >= 0 && lumped_->bodies[p].links.empty()) p = parent[p];
    return p < 0 ? -1 : rigid[p];
  };
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      if (rigid[a] == rigid[b] || above(rigid[b]) == rigid[a] || above(rigid[a]) == rigid[b]) disableBodies(a, b);
}

// A fixed base is the world, which has other models' colliders too, so the base's are listed one by one.
void RobotBuilder::disableBodies(int lumped_a, int lumped_b) {
  const int body_a = info_.bodies[lumped_a], body_b = info_.bodies[lumped_b];
  if (body_a != dynamics::WORLD_BODY) return world_->filter.disableBodies(body_a, body_b);
  const int count = static_cast<int>(world_->colliders.size());
  for (int a = 0; a < count; ++a) {
    if (!world_->colliders[a].enabled || world_->colliders[a].model != info_.model || world_->colliders[a].body != dynamics::WORLD_BODY)
      continue;
    for (int b = 0; b < count; ++b)
      if (world_->colliders[b].enabled && world_->colliders[b].body == body_b) world_->disabled_pairs.insert(std::minmax(a, b));
  }
}

void RobotBuilder::disableListedPairs() {
  const std::vector<int> own = world_->collidersOf(info_.model);
  const auto link = [this](int collider) { return world_->colliders[collider].link; };
  for (const auto& [first, second] : config_.disable_collisions) {
    const int link_a = model_->linkIndex(first), link_b = model_->linkIndex(second);
    for (const int a : own)
      for (const int b : own)
        if (link(a) == link_a && link(b) == link_b) world_->disabled_pairs.insert(std::minmax(a, b));
  }
}

bool RobotBuilder::crossAtStart(const contact::Collider& a, const contact::Collider& b, contact::NarrowPhaseWorkspace* workspace) const {
  const auto start = [this](const contact::Collider& c) -> Pose {
    return c.body == dynamics::WORLD_BODY ? c.X_BC : X_WB_[lumped_->link_placement[c.link].body] * c.X_BC;
  };
  const Pose X_WA = start(a), X_WB = start(b);
  contact::ContactManifold found;
  contact::narrowPhase({a, X_WA}, {b, X_WB}, {}, workspace, &found);
  return found.pierced && found.maxDepth() >= (1 + CROSSED) * (a.radius + b.radius);
}

// Contacts of links that cross from the start, as neighbours' neighbours in wrists do, would tear at joints that cannot part them.
void RobotBuilder::disableCrossings() {
  const std::vector<int> own = world_->collidersOf(info_.model);
  contact::NarrowPhaseWorkspace workspace;
  std::set<std::pair<int, int>> links;
  for (std::size_t i = 0; i < own.size(); ++i) {
    for (std::size_t j = i + 1; j < own.size(); ++j) {
      const contact::Collider &a = world_->colliders[own[i]], &b = world_->colliders[own[j]];
      const std::pair<int, int> pair = std::minmax(own[i], own[j]);
      if (!world_->filter.allows(a, b) || world_->disabled_pairs.count(pair) > 0) continue;
      if (!crossAtStart(a, b, &workspace)) continue;
      world_->disabled_pairs.insert(pair);
      links.insert(std::minmax(a.link, b.link));
    }
  }
  if (links.empty()) return;
  std::string words;
  for (const auto& [a, b] : links)
    words += fmt::format("{}{} and {}", words.empty() ? "" : ", ", model_->links[a].name, model_->links[b].name);
  note("links that cross where the robot starts never touch each other: " + words + "; initial_positions may part them");
}

}  // namespace blem_sim::sim
