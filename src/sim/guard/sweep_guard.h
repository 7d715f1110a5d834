// Pairs whose bare meshes meet, or nearly, on the way from one end of a solve to the other.
#pragma once

#include <vector>

#include "blem_sim/contact/broad_phase.h"
#include "blem_sim/contact/sweep.h"
#include "build/simulated_world.h"
#include "clouds/fading_points.h"
#include "contacts/constraints/made_solve.h"
#include "threads/step_threads.h"

namespace blem_sim::sim {

/** Two colliders that came too close within a solve. */
struct ClosePass {
  int a, b;
  double part;  ///< of the solve's length, 0 to 1: so long their layers last, or half of them if they touch already
  bool passed;  ///< nothing of their layers was left, so that they may be on each other's other side
};

/**
 * Watches the whole way, not only its ends: bodies move evenly from their old poses to the new ones (sweep.h), links of robots as far
 * beside that as their joints bend their ways. A pair comes too close where
 * less than SPARED of its layer is left, and passed where it is less than NOTHING. Two geometries without area (points, segments)
 * whose contact was not known cannot cross: they do both where they use up half of their layers. Pairs that cross already, half-spaces
 * (nothing passes these: a vertex below them is pushed up from any depth) and pairs without a layer are not asked. Bodies that move less
 * than their layers, or than the space known to be free around them, cost some comparisons.
 */
class SweepGuard {
 public:
  /** @param threads that look at pairs at once */
  explicit SweepGuard(StepThreads* threads) : threads_(threads) {}

  static constexpr double SPARED = 0.1, NOTHING = 0.02;  ///< of the layer

  /** @param arms as PairWatch knows them @param fading its crossings pass @return sorted by (a, b); lives until the next call */
  const std::vector<ClosePass>& look(const SimulatedWorld& world, const MadeSolve& made, const std::vector<double>& arms,
                                     const FadingPoints& fading);

 private:
  /** A pair at the start of the solve. */
  struct Nearness {
    double distance;  // [m] of the bare meshes, at least; infinite: they cannot come close in the solve
    bool known;       // contacts are known
  };
  void moveColliders(const SimulatedWorld& world, const MadeSolve& made, const std::vector<double>& arms);
  void bendWays(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& before, const std::vector<dynamics::BodyState>& after);
  contact::GeometrySweep sweepOf(const SimulatedWorld& world, int collider) const;
  Nearness nearnessOf(const SimulatedWorld& world, const MadeSolve& made, const FadingPoints& fading, const WatchedPair& pair) const;
  bool leavesWhatWasSearched(const SimulatedWorld& world, const WatchedPairs& watched) const;
  void lookAtOthers(const SimulatedWorld& world, const WatchedPairs& watched);
  void lookAt(const SimulatedWorld& world, int a, int b, const Nearness& nearness);

  StepThreads* threads_;
  const std::vector<dynamics::BodyState>*before_ = nullptr, *after_ = nullptr;
  std::vector<contact::ColliderMotion> motion_;  // poses at the start, and longest ways in the solve
  std::vector<double> bends_;                    // [m] by collider: how far its way may lie beside a straight one
  std::vector<double> turns_;                    // [rad] by model: largest of its links in the solve
  contact::BroadPhase other_pairs_;
  std::vector<Nearness> nearness_;  // by watched pair
  std::vector<ClosePass> close_;
};

}  // namespace blem_sim::sim
