// Energy that comes out of nothing, island by island.
#pragma once

#include <vector>

#include "blem_sim/dynamics/world.h"
#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/sim/simulator_types.h"
#include "contacts/constraints/made_solve.h"
#include "guard/body_islands.h"

namespace blem_sim::sim {

/** [J] that came out of nothing in a solve. */
struct EnergyGain {
  double total = 0;           ///< sum over islands
  double out_of_nothing = 0;  ///< the same without work that contacts do on purpose, and without apparent work
  bool beyond_bound = false;  ///< the part out of nothing exceeds its bound in some island
};

/**
 * Books, solve by solve, the kinetic energy of bodies and rotors, the potential energy and that of the springs of compliant contacts,
 * against the work of motors and joint friction. Contacts may only take from it. Each island has a book of its own: bodies that joints,
 * mimic joints, loops or contacts with a force tie together.
 *
 * Contacts do work on purpose: they correct depth, and part meshes that cross, at a bounded speed. Apparent work
 * (SolveResult::apparent_work) counts with it. Beyond both an island may gain FLOOR, less where it weighs less than 1 kg, and RELATIVE
 * times the energy that moves in it: kinetic energy, weights times their ways, work of motors and energy of springs.
 */
class EnergyBalance {
 public:
  static constexpr double FLOOR = 1e-6;     ///< [J], or [J/kg] below 1 kg: a speed of 1.4 mm/s out of rest
  static constexpr double RELATIVE = 1e-5;  ///< in a solve: 1 % in a thousand of them

  explicit EnergyBalance(const dynamics::SolverSettings& settings) : settings_(settings) {}

  /** Call at the start of a step; bodies may have been moved since the last one. */
  void start(const dynamics::World& world);
  /** Wrenches from outside in the next solve, whose work comes out of something. */
  void setLoads(const std::vector<BodyLoad>& loads) { loads_ = loads; }
  /** One more, which that solve has found. */
  void addLoad(const BodyLoad& load) { loads_.push_back(load); }
  /**
   * Books a solve that was accepted.
   * @param end contacts that were found at its end
   * @return never below 0. An impact's energy that is still to bounce is held back from one solve to the next: the share that the largest
   * restitution gives back of the energy that the solve before took
   */
  EnergyGain addSolve(const dynamics::World& world, const MadeSolve& made, const std::vector<contact::ContactManifold>& end);

  /** Forgets the energy that is held back: no impact is to bounce. */
  void clear() { held_.assign(held_.size(), 0); }
  /** @param bodies of the world */
  void save(int bodies, geometry::StateWriter* writer) const;
  /** @param bodies number of the world's bodies: energy is held back for each of them, or for none */
  void restore(int bodies, geometry::StateReader* reader);

 private:
  /** Book of an island, kept at its least body. */
  struct Book {
    double rise = 0;         // [J] of all energies, less the work of motors and joint friction
    double mass = 0;         // [kg]
    double moved = 0;        // [J] energy that moves in it, without sign
    double on_purpose = 0;   // [J] work of contacts that correct depth, and apparent work
    double held = 0;         // [J] that the solve before took, and that may bounce now
    double restitution = 0;  // largest of contacts that pushed
    double approach = 0;     // [J] work that impacts took
  };
  /** A contact that landed and has not left yet. */
  struct Landing {
    int body;
    double approach;  // [J] work that it took
    double left;      // part of its bounce that is still to come
  };

  void tie(const dynamics::World& world, const MadeSolve& made);
  void bookBodies(const dynamics::World& world, const MadeSolve& made);
  void bookLoads(const dynamics::World& world, double dt, const std::vector<dynamics::BodyState>& before,
                 const std::vector<dynamics::BodyState>& after);
  void bookJoints(const dynamics::World& world, double dt, const dynamics::SolveResult& result);
  void bookSprings(const dynamics::World& world, const MadeSolve& made, const std::vector<contact::ContactManifold>& end);
  void bookContacts(const MadeSolve& made);
  void holdBack();
  Book& bookOf(const dynamics::ContactConstraint& contact);
  /** Speed [m/s] of A's point against B's along the normal, at the poses of the solve's start. */
  double normalSpeed(const dynamics::ContactConstraint& contact, const std::vector<dynamics::BodyState>& states) const;

  dynamics::SolverSettings settings_;
  std::vector<dynamics::JointState> joints_;  // after the last solve
  std::vector<double> held_;                  // [J] by body: energy that its contacts may give back in the next solve; empty: none

  // The solve at hand.
  std::vector<BodyLoad> loads_;
  BodyIslands islands_;
  std::vector<Book> books_;
  std::vector<Vector3> coms_;  // [m] of bodies at its start, world axes
  std::vector<Vector3> ways_;  // [m] of theirs that weights work along: those of the mean velocity over what forces did to it
  std::vector<Landing> landings_;
};

}  // namespace blem_sim::sim
