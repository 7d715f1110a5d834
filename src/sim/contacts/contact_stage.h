// From body poses to contact constraints of the solver: broad phase, narrow phase, reduction.
#pragma once

#include <utility>
#include <vector>

#include "blem_sim/contact/broad_phase.h"
#include "blem_sim/contact/manifold.h"
#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/reduction/reduction.h"
#include "build/simulated_world.h"
#include "clouds/fading_points.h"
#include "contacts/contact_meetings.h"
#include "contacts/crossing_history.h"
#include "contacts/flush_surfaces.h"
#include "contacts/layer_stops.h"
#include "contacts/pair_searches.h"

namespace blem_sim::sim {

/** A contact in the solve: its pair, layer and kind. Goes with the constraint of the same index. */
struct SolvedContact {
  int collider_a, collider_b;
  double layer;  ///< [m] rA + rB
  bool pierced;
  double stop;    ///< [m] depth at which a layer's stop begins; 0 for other contacts
  bool recovers;  ///< of a pair of crossings()
};

/** Two colliders that may meet in the coming step. */
struct WatchedPair {
  int a, b;
  double margin;  ///< [m] distance beyond the layers within which they may meet at all
  double known;   ///< [m] distance beyond the layers within which their contacts are known
};

/** Two colliders of a pair that is not searched. */
struct PairLeftOut {
  int a, b;
};

/**
 * Finds contacts at the state at hand (contact_stage.cpp) and makes constraints of them (contact_constraints.cpp). The manifolds are a
 * function of the state and of crossings() alone, so those found at the end of an accepted step serve the next one, and after a restore
 * they are found anew, the same.
 */
class ContactStage {
 public:
  /** @param threads that search pairs at once; the result is the same for any number */
  ContactStage(const ContactConfig& config, int threads);

  /**
   * Pairs that may touch within the coming step of length dt [s].
   * @param bodies their states at hand, by slot
   * @param faster states of the same poses whose speeds bodies may reach: the larger speed counts. Null: bodies go on as they do
   */
  void broadPhase(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                  const std::vector<dynamics::BodyState>* faster, double dt);
  /** Finds the manifolds of these pairs: found(). */
  void narrowPhase(const SimulatedWorld& world);
  /** Makes found() the manifolds that the next solve starts from: current(). */
  void accept();
  /** Call after bodies or geometry changed other than by a step: no contact is known. */
  void forget() { known_ = false; }
  /** Choice of the last reduction: with stops() and crossings() all that the next step depends on here, beside the bodies' states. */
  reduction::ReductionMemory& memory() { return memory_; }
  const reduction::ReductionMemory& memory() const { return memory_; }
  LayerStops& stops() { return stops_; }
  const LayerStops& stops() const { return stops_; }
  bool known() const { return known_; }
  /**
   * At most k contacts per model out of current(), but three of each pair, as constraints, and the stops below soft ones. Contacts before
   * touch are those that will be met (ContactMeetings).
   * @param bodies states at hand, by slot @param expected as ContactMeetings takes it @param dt [s] of the solve
   */
  void reduction(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, const Expectation& expected, double dt);

  const std::vector<contact::ContactManifold>& found() const { return found_; }      ///< sorted by (a, b), none empty
  const std::vector<contact::ContactManifold>& current() const { return current_; }  ///< of the accepted state, before reduction
  const std::vector<dynamics::ContactConstraint>& constraints() const { return constraints_; }
  const std::vector<SolvedContact>& solved() const { return solved_; }
  const std::vector<WatchedPair>& watched() const { return current_search_.pairs; }  ///< of the accepted state
  /** [m] by collider: farthest point of its geometry's box from the body's centre of mass; 0 for static ones. */
  double arm(int collider) const { return arms_[collider]; }
  /** Poses of the accepted state, and how far each may move, by collider. */
  const std::vector<contact::ColliderMotion>& motion() const { return current_search_.motion; }
  /** Points that come and go: contacts that are found from now on are those of points as they are sunk. */
  FadingPoints& fading() { return fading_; }
  const FadingPoints& fading() const { return fading_; }
  /** Pairs that cross, or did and are not apart yet, in the accepted state. */
  CrossingHistory& crossings() { return current_search_.crossings; }
  const CrossingHistory& crossings() const { return current_search_.crossings; }
  /**
   * Forgets all that is remembered of a collider whose slot another one may take.
   * @return ids of its contacts in the last step, as the world knows them, and others that it does not know
   */
  std::vector<std::uint64_t> forgetCollider(int collider);
  int rawContacts() const;
  int reducedContacts() const;  ///< without stops
  /**
   * Pairs of the accepted state that were not looked at, sorted by (a, b). Two colliders are at one place if the middle of each one's box
   * is in the other's; of such pairs only some of each collider are looked at, since their number grows as the colliders' number squared.
   */
  const std::vector<PairLeftOut>& leftOut() const { return current_search_.left_out; }
  const reduction::ReductionLoss& reductionLoss() const { return reduction_loss_; }

 private:
  struct Search {
    std::vector<contact::ColliderMotion> motion;
    std::vector<WatchedPair> pairs;
    std::vector<PairLeftOut> left_out;  // sorted by (a, b)
    std::vector<Recovery> last_apart;   // by pair
    CrossingHistory crossings;
    FlushSurfaces flush;
  };
  void moveColliders(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                     const std::vector<dynamics::BodyState>* faster, double dt);
  double knownMargin(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                     const std::vector<dynamics::BodyState>* faster, const contact::ColliderPair& pair, double dt) const;
  bool isAtOnePlace(const SimulatedWorld& world, int a, int b) const;
  /** Pose in which a pair was last apart, as far as the accepted state knows. */
  Recovery lastApart(int a, int b) const;
  void keepWhatWasFound(std::size_t pairs);
  void addConstraints(const SimulatedWorld& world, const contact::ContactManifold& all, contact::ContactManifold& manifold);
  void addStops(const SimulatedWorld& world, const contact::ContactManifold& all, double friction);

  const ContactConfig config_;
  const reduction::Reduction* method_;
  reduction::ReductionMemory memory_;
  LayerStops stops_;
  bool known_ = false;
  std::vector<double> arms_;
  contact::BroadPhase pair_search_;
  Search search_, current_search_;
  std::vector<int> at_one_place_;  // by collider: its pairs at one place
  PairSearches searches_;
  FadingPoints fading_;
  ContactMeetings meetings_;
  std::vector<contact::ContactManifold> found_, current_, reduced_;
  std::vector<contact::ContactManifold> spare_;  // only their memory
  std::vector<dynamics::ContactConstraint> constraints_;
  std::vector<SolvedContact> solved_;
  std::vector<int> model_a_, model_b_;  // of each of current_
  reduction::ReductionLoss reduction_loss_;
};

}  // namespace blem_sim::sim
