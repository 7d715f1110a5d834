// Contacts before touch that pushed in a solve, though what they pushed was not met: motors or other pushes had changed its way.
#pragma once

#include <cstddef>
#include <vector>

#include "blem_sim/dynamics/world_types.h"
#include "contacts/constraints/contact_meetings.h"
#include "contacts/constraints/made_solve.h"

namespace blem_sim::sim {

/**
 * Finds the pairs of robots whose contacts before touch pushed in a solve while the pair moved across them, and of which nothing touches
 * anew at its end. Whether they push rightly is told by a solve without them: its velocities are those that the pair meets, or passes,
 * with.
 */
class EarlyPushes {
 public:
  /** @param found contacts at the end of the solve @return whether there are any */
  bool find(const SimulatedWorld& world, const MadeSolve& made, const FoundContacts& found);
  /** Tells where a solve without those contacts ends. @param bodies states at its end, by slot */
  void expect(const std::vector<dynamics::BodyState>& bodies) { expectation_.bodies = bodies; }
  void clear();
  const Expectation& expectation() const { return expectation_; }

 private:
  bool isEarly(const SimulatedWorld& world, const MadeSolve& made, const FoundContacts& found, std::size_t constraint) const;

  Expectation expectation_;
};

}  // namespace blem_sim::sim
