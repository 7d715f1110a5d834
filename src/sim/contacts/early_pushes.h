// Contacts before touch that pushed in a solve, though what they pushed was not met: motors or other pushes had changed its way.
#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/dynamics/world_types.h"
#include "contacts/contact_meetings.h"

namespace blem_sim::sim {

class ContactStage;

/**
 * Finds the pairs of robots whose contacts before touch pushed in a solve while the pair moved across them, and of which nothing touches
 * anew at its end. Whether they push rightly is told by a solve without them: its velocities are those that the pair meets, or passes,
 * with.
 */
class EarlyPushes {
 public:
  /**
   * @param contacts of the solve, with what was found at its end @param forces [N] of its constraints
   * @param bodies states at its end, by slot @param dt [s] of the solve
   * @return whether there are any
   */
  bool find(const SimulatedWorld& world, const ContactStage& contacts, const std::vector<Vector3>& forces,
            const std::vector<dynamics::BodyState>& bodies, double dt);
  /** Tells where a solve without those contacts ends. @param bodies states at its end, by slot */
  void expect(const std::vector<dynamics::BodyState>& bodies) { expectation_.bodies = bodies; }
  void clear();
  const Expectation& expectation() const { return expectation_; }

 private:
  bool isEarly(const SimulatedWorld& world, const ContactStage& contacts, std::size_t constraint,
               const std::vector<dynamics::BodyState>& bodies, double dt) const;

  Expectation expectation_;
};

}  // namespace blem_sim::sim
