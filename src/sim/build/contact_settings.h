// Boundary width and surface of a shape: the innermost setting counts.
#pragma once

#include <initializer_list>
#include <map>
#include <string>

#include "blem_sim/sim/config.h"

namespace blem_sim::sim {

struct ContactSettings {
  BoundaryWidth boundary_width;
  contact::SurfaceProperties surface;
  bool shrink = false;
};

/** Width that environments start from. */
inline BoundaryWidth widthOfEnvironments(const ContactConfig& defaults) {
  return defaults.boundary_width.automatic ? defaults.boundary_width : BoundaryWidth();
}

/** @param boundary_width to start from @param overrides outermost first */
inline ContactSettings contactSettings(const BoundaryWidth& boundary_width, const ContactConfig& defaults,
                                       std::initializer_list<const ContactOverrides*> overrides) {
  ContactSettings settings{boundary_width, defaults.surface, defaults.shrink};
  for (const ContactOverrides* o : overrides) {
    if (!o) continue;
    settings.boundary_width = o->boundary_width.value_or(settings.boundary_width);
    settings.surface.friction = o->friction.value_or(settings.surface.friction);
    settings.surface.restitution = o->restitution.value_or(settings.surface.restitution);
    settings.surface.impact_friction_factor = o->impact_friction_factor.value_or(settings.surface.impact_friction_factor);
    settings.surface.impact_friction_speed = o->impact_friction_speed.value_or(settings.surface.impact_friction_speed);
    settings.surface.stiffness = o->stiffness.value_or(settings.surface.stiffness);
    settings.shrink = o->shrink.value_or(settings.shrink);
    settings.surface.damping = o->damping.value_or(settings.surface.damping);
  }
  return settings;
}

/** Settings of a link; null if it has none. */
inline const ContactOverrides* overridesOf(const std::map<std::string, ContactOverrides>& links, const std::string& link) {
  const auto found = links.find(link);
  return found == links.end() ? nullptr : &found->second;
}

}  // namespace blem_sim::sim
