// Does energy come out of nothing?
#pragma once

#include <vector>

#include "blem_sim/dynamics/world.h"
#include "contact_stage.h"
#include "number_reader.h"

namespace blem_sim {

/**
 * Books, solve by solve, the kinetic energy of bodies and rotors, the potential energy and what springs of compliant contacts hold, against
 * the work of motors and joint friction. Contacts may only take from it.
 */
class EnergyBalance {
 public:
  /** At the start of a step; bodies may have been moved since the last one. */
  void start(const World& world);
  /**
   * After a solve that was accepted.
   * @param dt [s] its length
   * @param contacts it was made with
   * @param forces [N] of those contacts
   * @param before, after bodies at its start and end
   * @return [J] gained by it out of nothing, never below 0. An impact's energy that is to bounce is held back from one solve to the next:
   * as much of what the solve before took as the largest restitution gives back
   */
  double addSolve(const World& world, double dt, const ContactStage& contacts, const std::vector<Vector3>& forces,
                  const std::vector<BodyState>& before, const std::vector<BodyState>& after);

  /** [J] kinetic and potential energy of the bodies, as of the last start or solve. */
  double energyOfBodies() const { return bodies_; }

  /** No impact is to bounce. */
  void clear() { bounce_ = 0; }
  void append(std::vector<double>* numbers) const { numbers->push_back(bounce_); }
  void read(NumberReader* reader) { bounce_ = reader->number(); }

 private:
  /** [J] done by motors and joint friction since the last time. */
  double takeWork(const World& world, double dt);

  double bodies_ = 0;               // [J] without rotors
  double energy_ = 0;               // [J] with them
  std::vector<JointState> joints_;  // after the last solve
  double bounce_ = 0;               // [J] at most, that the next solve may give back
};

}  // namespace blem_sim
