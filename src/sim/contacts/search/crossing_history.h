// Pairs of colliders whose bare meshes cross, and the poses in which they were last apart.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/contact/manifold.h"
#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/geometry/types.h"

namespace blem_sim::sim {

/** A pair whose bare meshes cross, or did and are not apart yet. */
struct Recovery {
  int a, b;
  bool known;  ///< false if the pair crossed from the start
  Pose X_AB;   ///< geometry of B in A's when they were last apart
};

/**
 * Contacts of these pairs may contradict each other: they push as dampers that let go at 0.1 m/s, less while no more than the layer is
 * used up. Part of the saved state.
 */
class CrossingHistory {
 public:
  bool empty() const { return recoveries_.empty(); }
  /** The pair's recovery; null if it is apart. */
  const Recovery* find(int a, int b) const;
  void clear() { recoveries_.clear(); }
  /**
   * Becomes the history of the next state: pairs that cross there, and those of the history before that are not apart yet.
   * @param last_apart of the pairs searched, sorted by (a, b) @param crossed whether their bare meshes cross @param manifolds theirs, as
   * what fades has left them
   */
  void goOn(const CrossingHistory& before, const std::vector<Recovery>& last_apart, const std::vector<std::uint8_t>& crossed,
            const std::vector<contact::ContactManifold>& manifolds);
  void forget(int collider);
  void save(geometry::StateWriter* writer) const;
  /** @param colliders whose pairs they may be */
  void restore(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader);

 private:
  std::vector<Recovery> recoveries_;  // sorted by (a, b)
};

}  // namespace blem_sim::sim
