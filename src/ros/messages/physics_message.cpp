#include "messages/physics_message.h"

namespace blem_sim::node {

ODEPhysics toOdePhysics(const sim::SimulationConfig& config) {
  ODEPhysics physics;
  physics.sor_pgs_iters = static_cast<std::uint32_t>(config.solver.quick_step_iterations);
  physics.contact_max_correcting_vel = config.solver.max_correction_speed;
  physics.cfm = config.solver.cfm;
  physics.erp = config.solver.correction_fraction;
  physics.max_contacts = static_cast<std::uint32_t>(config.contact.max_contacts_per_robot);
  return physics;
}

std::string differencesIn(const ODEPhysics& given, const sim::SimulationConfig& config) {
  const ODEPhysics own = toOdePhysics(config);
  std::string names;
  const auto compare = [&](const char* name, double value, double here) {
    if (value != 0 && value != here) names += std::string(" ") + name;
  };
  compare("auto_disable_bodies", given.auto_disable_bodies, own.auto_disable_bodies);
  compare("sor_pgs_precon_iters", given.sor_pgs_precon_iters, own.sor_pgs_precon_iters);
  compare("sor_pgs_iters", given.sor_pgs_iters, own.sor_pgs_iters);
  compare("sor_pgs_w", given.sor_pgs_w, own.sor_pgs_w);
  compare("sor_pgs_rms_error_tol", given.sor_pgs_rms_error_tol, own.sor_pgs_rms_error_tol);
  compare("contact_surface_layer", given.contact_surface_layer, own.contact_surface_layer);
  compare("contact_max_correcting_vel", given.contact_max_correcting_vel, own.contact_max_correcting_vel);
  compare("cfm", given.cfm, own.cfm);
  compare("erp", given.erp, own.erp);
  compare("max_contacts", given.max_contacts, own.max_contacts);
  return names;
}

}  // namespace blem_sim::node
