#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "blem_sim/contact/collider.h"

namespace blem_sim::contact {

/** A pair of colliders that may be within rA + rB + margin of each other; a < b. */
struct ColliderPair {
  int a, b;
  double margin;  ///< [m] reach of the narrow phase beyond the layers: a speculative contact's largest gap
};

/** Rules for pairs of colliders that may touch at all. Static against static and two colliders of one body never do. */
class CollisionFilter {
 public:
  /** Colliders of one model touch each other only if this is on (robots; default off). */
  void setSelfCollision(int model, bool on);
  /** Colliders of these links touch any other collider of their model; the model's others do not touch each other. */
  void setSelfCollidingLinks(int model, const std::set<int>& links);
  const std::set<int>& selfCollidingLinks(int model) const;  ///< empty: all of a model that self-collides
  bool selfCollides(int model) const { return self_colliding_models_.count(model) > 0; }
  /** Two bodies that never touch: neighbours at a joint, listed pairs. Order does not matter. */
  void disableBodies(int body_a, int body_b);
  /** Forgets the rules about a body whose slot another one may take. */
  void forgetBody(int body);
  bool allows(const Collider& a, const Collider& b) const;

 private:
  std::set<int> self_colliding_models_;
  std::map<int, std::set<int>> self_colliding_links_;  // by model, of those where only some do
  std::set<std::pair<int, int>> disabled_bodies_;
};

/** Motion of a collider over the coming step, for its margin. */
struct ColliderMotion {
  Pose X_WC;         ///< geometry frame in the world
  double reach = 0;  ///< [m] bound on the motion of any of its points in the coming step
};

/** Search for pairs, with its buffers; they are used again, so that a warm search allocates nothing. */
class BroadPhase {
 public:
  /**
   * Pairs whose layers may come within reach, sorted by (a, b): a sweep along one axis over world boxes, from 64 boxes on within cells of
   * the two other axes, so that the cost grows with the number of boxes. A pair's margin is
   * min(max_margin, max(base_margin, reach_a + reach_b)). Threads of the TBB arena at hand share the search of many boxes.
   * @return lives until the next search
   */
  const std::vector<ColliderPair>& find(const std::vector<Collider>& colliders, const std::vector<ColliderMotion>& motion,
                                        const CollisionFilter& filter, double base_margin, double max_margin);
  /** Number of pairs of boxes that the last search compared. */
  std::int64_t compared() const { return all_.compared; }

 private:
  /** A collider in the sweep: its box in the world, and its reach beyond it. */
  struct SweepBox {
    int collider;
    int model;             // model whose other colliders it never touches, -1: none
    Vector3 lower, upper;  // [m] world, without the layer
    double reach;          // [m] layer and this collider's share of the margin, at most
  };
  struct SweepStart {
    double at;       // [m] along the axis
    int box, model;  // as in the box
  };
  /** A box in a cell of the two axes of largest spread. */
  struct CellEntry {
    std::uint64_t cell;
    double at;  // [m] where it starts along the third axis
    int box;
  };
  /** Pairs that a piece of the search finds, in its order. */
  struct Found {
    std::vector<ColliderPair> pairs;
    std::int64_t compared = 0;
  };
  class Search;

  std::vector<int> half_spaces_;
  std::vector<SweepBox> boxes_;
  std::vector<SweepStart> starts_;
  std::vector<CellEntry> entries_;
  std::vector<double> sizes_;      // [m] of boxes along an axis
  std::vector<int> large_starts_;  // those of starts_ whose boxes have so many cells that they are swept by themselves
  std::vector<char> large_;        // box by box
  std::vector<Found> found_;       // piece by piece of entries_
  Found all_;                      // pairs sorted by (a, b)
};

}  // namespace blem_sim::contact
