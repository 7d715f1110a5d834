// Solves made by hand whose energy is booked, and scenes whose status bits are read.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "guard/energy_balance.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {

constexpr double BALANCE_STEP = 1e-3;

/** Bodies of 2 kg in free space, and the result of a solve made by hand. */
class HandMadeSolve {
 public:
  explicit HandMadeSolve(int bodies, const Vector3& gravity = Vector3::Zero()) : world(gravity, dynamics::SolverSettings()) {
    for (int b = 0; b < bodies; ++b) {
      dynamics::BodySpec spec;
      spec.name = "body" + std::to_string(b);
      spec.inertial.mass = 2;
      spec.inertial.inertia = Vector3(0.1, 0.2, 0.3).asDiagonal();
      spec.X_WB = makePose({1.0 * b, 0, 0});
      world.addBody(spec);
      before.push_back(world.bodyState(b));
    }
    after = before;
  }
  EnergyGain gain() {
    EnergyBalance balance{dynamics::SolverSettings()};
    balance.start(world);
    dynamics::SolveResult solved;
    solved.axis_efforts.assign(world.jointCount(), 0);
    solved.contact_forces.assign(contacts.constraints.size(), force);
    return balance.addSolve(world, {start, contacts, drives, solved, before, after, BALANCE_STEP}, end);
  }

  dynamics::World world;
  FoundContacts start;
  SolverContacts contacts;
  std::vector<dynamics::JointDrive> drives;
  std::vector<dynamics::BodyState> before, after;
  Vector3 force = Vector3::Zero();            // [N] of each contact
  std::vector<contact::ContactManifold> end;  // found at its end
};

/** Every bit that was set in so long. */
inline std::uint32_t statusOf(const SimulationConfig& config, double seconds, const JointCommandMessage& command = {}) {
  Simulator simulator(config, model::UriResolver());
  if (!command.joints.empty()) simulator.commandJoints(0, command);
  std::uint32_t status = 0;
  for (long i = 0; i < std::lround(seconds / config.time_step); ++i) status |= simulator.step().status;
  return status;
}

inline SimulationConfig onGround(const std::vector<ObjectConfig>& objects) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = objects;
  return config;
}

}  // namespace blem_sim::sim
