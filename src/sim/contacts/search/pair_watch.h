// Broad phase: the pairs of colliders that may meet in the coming solve, and up to which distance their contacts are to be known.
#pragma once

#include <vector>

#include "blem_sim/contact/broad_phase.h"
#include "blem_sim/dynamics/world_types.h"
#include "build/simulated_world.h"
#include "threads/step_threads.h"

namespace blem_sim::sim {

/** Two colliders that may meet in the coming step: within the pair's margin beyond the layers, if at all. */
struct WatchedPair : contact::ColliderPair {
  double known;  ///< [m] distance beyond the layers within which their contacts are known
};

/** Two colliders of a pair that is not searched. */
struct PairLeftOut {
  int a, b;
};

/** Pairs of a state, with the poses that they are searched at. */
struct WatchedPairs {
  std::vector<contact::ColliderMotion> motion;  ///< poses, and how far each may move, by collider
  std::vector<WatchedPair> pairs;               ///< sorted by (a, b)
  /**
   * Pairs that are not looked at, sorted by (a, b). Two colliders are at one place if the middle of each one's box is in the other's; of
   * such pairs only some of each collider are looked at, since their number grows as the colliders' number squared.
   */
  std::vector<PairLeftOut> left_out;
};

/** A state of the bodies, and the time that they go on from there. */
struct StateAhead {
  const SimulatedWorld& world;
  const std::vector<dynamics::BodyState>& bodies;  ///< at hand, by slot
  /** States of the same poses whose speeds bodies may reach: the larger speed counts. Null: bodies go on as they do. */
  const std::vector<dynamics::BodyState>* faster;
  double dt;  ///< [s]
};

/** Finds the pairs to be searched, in memory that is kept between steps. */
class PairWatch {
 public:
  /** @param threads that look at pairs at once */
  explicit PairWatch(StepThreads* threads) : threads_(threads) {}

  /** Pairs that may touch within the time ahead. @param watched overwritten */
  void find(const StateAhead& ahead, WatchedPairs* watched);
  /** [m] by collider, as of the last find: farthest point of its geometry's box from the body's centre of mass; 0 for static ones. */
  const std::vector<double>& arms() const { return arms_; }
  /** Call when a collider's slot may be taken by another one, or a centre of mass has moved. */
  void forget() { arms_.clear(); }

 private:
  void measureArms(const SimulatedWorld& world);
  void moveColliders(const StateAhead& ahead, std::vector<contact::ColliderMotion>* motion);
  bool isOneTooMany(const SimulatedWorld& world, const std::vector<contact::ColliderMotion>& motion, const contact::ColliderPair& pair);

  StepThreads* threads_;
  std::vector<double> arms_;
  contact::BroadPhase broad_phase_;
  std::vector<int> at_one_place_;  // by collider: its pairs at one place
};

}  // namespace blem_sim::sim
