// Colliders of a robot, and the pairs of them that never touch.
#include <algorithm>
#include <vector>

#include "build/contact_settings.h"
#include "build/robot_builder.h"

namespace blem_sim::sim {

void RobotBuilder::addColliders(SurfaceLibrary* surfaces) {
  double mass = 0;
  for (const model::LumpedBody& body : lumped_->bodies) mass += body.inertial.mass;
  const WidthNeeds needs = needsOfLink(mass * world_->gravityToHold());
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
      const auto geometry = surfaces->geometry(shape.mesh, nullptr, shape.cylinder);
      surfaces->chooseWidth(*geometry, needs, shape.radius, &settings, &report);
      surfaces->fit(geometry, settings, shape.radius, &report, &collider);
      const bool has_layer = !(shape.radius > 0) && !collider.outside;
      const double width = shape.radius > 0 ? shape.radius : settings.boundary_width.metres;
      own_.push_back({world_->addCollider(collider, width, settings.surface, report), has_layer ? width : 0});
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

}  // namespace blem_sim::sim
