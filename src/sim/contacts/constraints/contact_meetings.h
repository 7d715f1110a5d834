// Contacts before touch: the poses where they are met, or passed sideways.
#pragma once

#include <cstddef>
#include <vector>

#include "contacts/constraints/pair_way.h"
#include "contacts/motion/body_ways.h"
#include "contacts/search/found_contacts.h"
#include "threads/step_threads.h"

namespace blem_sim::sim {

/** Two colliders whose contacts before touch are looked at once more. */
struct PairAside {
  int a, b;
};

/** Way of some pairs that is known better than from the velocities at hand. */
struct Expectation {
  std::vector<PairAside> pairs;             ///< sorted by (a, b)
  std::vector<dynamics::BodyState> bodies;  ///< states at the end of the solve; empty: contacts that do not bear are left out
};

/** A solve that is to be made. */
struct SolveAhead {
  const SimulatedWorld& world;
  const std::vector<dynamics::BodyState>& bodies;  ///< of the state at hand, by slot
  const FoundContacts& contacts;                   ///< of that state
  const FadingPoints& fading;                      ///< applied to contacts that are found on the way
  const Expectation& expected;                     ///< pairs that go on otherwise than bodies do at hand
  double dt;                                       ///< [s] its length
  contact::NarrowPhaseWorkspace* workspace;        ///< for searches on the way
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
  /** @param threads that look at pairs at once */
  explicit ContactMeetings(StepThreads* threads) : threads_(threads) {}

  void look(const SolveAhead& ahead);
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
  void findSupports(const SimulatedWorld& world, const FoundContacts& contacts);
  ColliderWay wayOf(const SolveAhead& ahead, int collider) const;
  WayOfPair wayOfPair(const SolveAhead& ahead, const contact::ContactManifold& now) const;
  ColliderWay expectedWayOf(const SolveAhead& ahead, int collider) const;
  double depthOf(const SimulatedWorld& world, int collider) const;
  bool isDoubtful(const SolveAhead& ahead, const contact::ContactManifold& now) const;
  void lookAt(const SolveAhead& ahead, std::size_t manifold);
  void lookAgain(const SolveAhead& ahead, std::size_t manifold);
  void keepWhatBears(const SolveAhead& ahead, std::size_t manifold);
  void follow(const SolveAhead& ahead, std::size_t manifold, WayOfPair* way);
  std::vector<contact::Contact>* room(std::size_t manifold);

  StepThreads* threads_;
  std::vector<Support> supports_;  // by body
  BodyWays ways_;
  PairWay way_;
  std::vector<char> is_doubtful_;  // by manifold
  std::vector<Replaced> replaced_;
  std::size_t replaced_count_ = 0;  // of them; the others are room
};

}  // namespace blem_sim::sim
