// Colliders of a robot, and the pairs of them that never touch.
#include <algorithm>

#include "build/contact_settings.h"
#include "build/robot_builder.h"

namespace blem_sim {

void RobotBuilder::addColliders(SurfaceLibrary* surfaces) {
  for (std::size_t link = 0; link < model_->links.size(); ++link) {
    const LinkModel& description = model_->links[link];
    const auto overrides = config_.links.find(description.name);
    const ContactSettings settings = contactSettings(contact_.boundary_width, contact_,
                                                     {&config_.contact, overrides == config_.links.end() ? nullptr : &overrides->second});
    const LinkPlacement& placement = lumped_->link_placement[link];
    const int body = info_.bodies[placement.body];
    for (const CollisionShape& shape : description.collisions) {
      Collider collider;
      collider.name = config_.name + "::" + description.name;
      collider.body = body;
      collider.model = info_.model;
      collider.link = static_cast<int>(link);
      collider.X_BC = body == WORLD_BODY ? config_.X_WR * placement.X_BL : placement.X_BL;
      MeshReport report = shape.report;
      collider.geometry = surfaces->fitted(surfaces->geometry(shape.mesh), settings, shape.radius, &report);
      world_->addCollider(collider, shape.radius > 0 ? shape.radius : settings.boundary_width, settings.surface, report);
    }
  }
}

// Bodies joined by a joint never touch; the bodies inside a planar joint have no links and are seen through. A fixed base is the world,
// which has other models' colliders too, so the base's are listed one by one.
void RobotBuilder::disableNeighbours() {
  std::vector<int> parent(lumped_->bodies.size(), -1);
  for (const LumpedJoint& joint : lumped_->joints) parent[joint.child] = joint.parent;
  for (std::size_t child = 1; child < parent.size(); ++child) {
    int p = parent[child];
    while (p >= 0 && lumped_->bodies[p].links.empty()) p = parent[p];
    if (p < 0) continue;
    if (info_.bodies[p] != WORLD_BODY) {
      world_->filter.disableBodies(info_.bodies[p], info_.bodies[child]);
      continue;
    }
    const int count = static_cast<int>(world_->colliders.size());
    for (int a = 0; a < count; ++a) {
      if (!world_->colliders[a].enabled || world_->colliders[a].model != info_.model || world_->colliders[a].body != WORLD_BODY) continue;
      for (int b = 0; b < count; ++b)
        if (world_->colliders[b].enabled && world_->colliders[b].body == info_.bodies[child])
          world_->disabled_pairs.insert(std::minmax(a, b));
    }
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

}  // namespace blem_sim
