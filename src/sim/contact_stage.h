// From body poses to what the solver takes: broad phase, narrow phase, reduction.
#pragma once

#include <vector>

#include "blem_sim/contact/broad_phase.h"
#include "blem_sim/contact/manifold.h"
#include "blem_sim/dynamics/world.h"
#include "simulated_world.h"

namespace blem_sim {

/** A contact in the solve: which of whose manifolds it is. Goes with the constraint of the same index. */
struct SolvedContact {
  int collider_a, collider_b;
  double layer;  ///< [m] rA + rB
  bool pierced;
};

/**
 * Finds contacts at the state at hand. The manifolds are a function of the state alone, so those found at the end of an accepted step
 * serve the next one, and after a restore they are found anew, the same.
 */
class ContactStage {
 public:
  explicit ContactStage(const ContactConfig& config);

  /** Pairs that may touch within the coming step of length dt [s]. */
  void broadPhase(const SimulatedWorld& world, double dt);
  /** Their manifolds: found(). */
  void narrowPhase(const SimulatedWorld& world);
  /** What was found is the state the next solve starts from. */
  void accept();
  /** After bodies or geometry changed other than by a step: nothing is known. */
  void forget() { known_ = false; }
  bool known() const { return known_; }
  /** At most k contacts per model out of current(), as constraints. */
  void reduction(const SimulatedWorld& world);

  const std::vector<ContactManifold>& found() const { return found_; }      ///< sorted by (a, b), none empty
  const std::vector<ContactManifold>& current() const { return current_; }  ///< of the accepted state, before reduction
  const std::vector<ContactConstraint>& constraints() const { return constraints_; }
  const std::vector<SolvedContact>& solved() const { return solved_; }
  int rawContacts() const;
  /** A model has as many contacts as it may, and others were left out. */
  bool budgetUsedUp() const { return budget_used_up_; }

 private:
  void moveColliders(const SimulatedWorld& world, double dt);
  void addConstraints(const SimulatedWorld& world, const ContactManifold& manifold);

  const ContactConfig config_;
  const Reduction* method_;
  bool known_ = false;
  std::vector<double> arms_;  ///< [m] by collider: farthest point of its geometry from the body's centre of mass
  std::vector<ColliderMotion> motion_;
  std::vector<ColliderPair> pairs_;
  std::vector<ContactManifold> found_, current_, reduced_;
  std::vector<ContactConstraint> constraints_;
  std::vector<SolvedContact> solved_;
  bool budget_used_up_ = false;
};

}  // namespace blem_sim
