// Reduction: from the manifolds of the state at hand to the constraints of the solve.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/reduction/reduction.h"
#include "build/simulated_world.h"
#include "contacts/constraints/contact_ids.h"
#include "contacts/constraints/contact_meetings.h"
#include "contacts/constraints/layer_stops.h"
#include "threads/step_threads.h"

namespace blem_sim::sim {

/** A contact in the solve: its pair, layer and kind. Goes with the constraint of the same index. */
struct SolvedContact {
  int collider_a, collider_b;
  std::uint64_t id;  ///< of the contact in the pair's manifold
  double layer;      ///< [m] rA + rB
  bool pierced;
  double stop;    ///< [m] depth at which a layer's stop begins; 0 for other contacts
  bool recovers;  ///< of a pair of FoundContacts::crossings
  bool bears;     ///< as bears() has it
};

/** Contacts as the solver takes them. */
struct SolverContacts {
  std::vector<dynamics::ContactConstraint> constraints;
  std::vector<SolvedContact> solved;  ///< by constraint
  int reduced = 0;                    ///< number of constraints without stops
  reduction::ReductionLoss loss;
};

/** Makes at most k constraints per model, but three of each pair, and the stops below soft ones. */
class ConstraintMaker {
 public:
  /** @param threads that look at pairs and reduce them at once */
  ConstraintMaker(const ContactConfig& config, StepThreads* threads);

  /**
   * Contacts before touch are those that will be met (ContactMeetings).
   * @param manifolds those of ahead.contacts: lent, and given back as they were
   * @return valid until the next call
   */
  const SolverContacts& make(const SolveAhead& ahead, std::vector<contact::ContactManifold>* manifolds);
  /** Choice of the last reduction: with stops() and the crossings all that the next solve's contacts depend on beside the bodies' states.
   */
  reduction::ReductionMemory& memory() { return memory_; }
  const reduction::ReductionMemory& memory() const { return memory_; }
  LayerStops& stops() { return stops_; }
  const LayerStops& stops() const { return stops_; }
  /**
   * Forgets the choices of a collider whose slot another one may take.
   * @return ids of its contacts in the last step, as the world knows them, and others that it does not know
   */
  std::vector<std::uint64_t> forget(int collider);

 private:
  void reduce(const SimulatedWorld& world, const std::vector<contact::ContactManifold>& manifolds);
  void addConstraints(const SolveAhead& ahead, const contact::ContactManifold& all, contact::ContactManifold& manifold);
  void addStops(const SimulatedWorld& world, const contact::ContactManifold& all, double friction);

  const ContactConfig config_;
  StepThreads* threads_;
  const reduction::Reduction* method_;
  reduction::ReductionMemory memory_;
  reduction::ReductionWorkspace workspace_;
  LayerStops stops_;
  ContactMeetings meetings_;
  std::vector<contact::ContactManifold> reduced_;
  std::vector<int> model_a_, model_b_;  // of each manifold
  SolverContacts made_;
};

}  // namespace blem_sim::sim
