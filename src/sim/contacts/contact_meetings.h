// Contacts before touch: the poses where they are met, or passed sideways.
#pragma once

#include <cstddef>
#include <vector>

#include "contacts/body_ways.h"
#include "contacts/pair_way.h"

namespace blem_sim::sim {

class ContactStage;

/** Two colliders whose contacts before touch are looked at once more. */
struct PairAside {
  int a, b;
};

/** Way of some pairs that is known better than from the velocities at hand. */
struct Expectation {
  std::vector<PairAside> pairs;             ///< sorted by (a, b)
  std::vector<dynamics::BodyState> bodies;  ///< states at the end of the solve; empty: contacts that do not touch are left out
};

/**
 * A contact before touch bounds the closing speed along the normal of its pose. While a body moves across that normal, the contact's
 * features pass each other, or meet along another normal. So a pair that, moving on freely, would use up a gap while it moves across it is
 * followed on its way through the solve, to the pose where its layers first touch, or to the nearest pose if they do not. Contacts before
 * touch that would act, and are not met there, are replaced by those of that pose, seen from the pose at hand: they let the pair go as far
 * as to the meeting. If nothing is met, none acts on the motion at hand, and a motion that changes in the solve is bounded by the planes of
 * the nearest pose. Contacts that touch, those whose gap will not be used up, and those that are met as they are stay as they are.
 */
class ContactMeetings {
 public:
  /**
   * @param contacts of the state at hand @param bodies its states, by slot @param flush surfaces that meet at it
   * @param expected pairs that go on otherwise than bodies do at hand @param dt [s] of the solve
   */
  void look(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, const ContactStage& contacts,
            const FlushSurfaces& flush, const Expectation& expected, double dt);
  /** Exchanges the contacts of these manifolds for those that are to be solved; a second time back. */
  void exchange(std::vector<contact::ContactManifold>* manifolds);

 private:
  struct Support {
    bool touches = false;  // the body touches something
    double depth = 0;      // [m] of its deepest contact, at least 0
  };
  struct Replaced {
    std::size_t manifold;
    std::vector<contact::Contact> contacts;
  };
  void findSupports(const SimulatedWorld& world, const std::vector<contact::ContactManifold>& manifolds);
  ColliderWay wayOf(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, const ContactStage& contacts, int collider,
                    double dt) const;
  double depthOf(const SimulatedWorld& world, int collider) const;
  void lookAt(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, const ContactStage& contacts,
              const FlushSurfaces& flush, std::size_t manifold, double dt);
  void lookAgain(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, const ContactStage& contacts,
                 const FlushSurfaces& flush, const Expectation& expected, std::size_t manifold, double dt);
  void follow(const SimulatedWorld& world, const ContactStage& contacts, const FlushSurfaces& flush, std::size_t manifold, WayOfPair* way);
  std::vector<contact::Contact>* room(std::size_t manifold);

  std::vector<Support> supports_;  // by body
  BodyWays ways_;
  PairWay way_;
  std::vector<Replaced> replaced_;
  std::size_t replaced_count_ = 0;  // of them; the others are room
};

}  // namespace blem_sim::sim
