// The narrow phase of many pairs, on several threads, each pair with its memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blem_sim/contact/collider_pairs.h"
#include "blem_sim/contact/narrow_phase.h"
#include "blem_sim/contact/surface_cover.h"
#include "build/simulated_world.h"
#include "clouds/fading_points.h"
#include "contacts/search/found_contacts.h"
#include "threads/step_threads.h"

namespace blem_sim::sim {

/** Searches pairs, each with a memory that lives while the pair is watched; then another gets it. Memories change no result, so they are
 *  no state. */
class PairSearches {
 public:
  /** @param threads that search pairs at once */
  explicit PairSearches(StepThreads* threads);

  /**
   * Finds the contacts of pairs at their poses.
   * @param before contacts of the last accepted state @param fading points that come and go, applied to what is found
   * @param pairs swapped with those of `found` @param found overwritten, its memory used again
   */
  void find(const SimulatedWorld& world, const FoundContacts& before, const FadingPoints& fading, WatchedPairs* pairs,
            FoundContacts* found);
  /** Takes over what a search of a pair beside the steps has learnt. */
  void know(int a, int b, contact::NarrowPhaseMemory memory);
  /** Room for searches between calls of find, on its caller's thread. */
  contact::NarrowPhaseWorkspace* workspace() { return &workspaces_.front().search; }
  /** Forgets the pairs of a collider whose slot another one may take. */
  void forget(int collider);

 private:
  struct Known {
    int a, b;
    contact::NarrowPhaseMemory memory;
  };
  void watch(const std::vector<WatchedPair>& pairs);
  void giveBack(const std::vector<WatchedPair>& pairs);
  contact::NarrowPhaseMemory takeSpare();
  void makeRoom(std::size_t pairs, std::vector<contact::ContactManifold>* manifolds);
  void keepWhatWasFound(std::size_t pairs, FoundContacts* found);

  std::vector<Known> known_, before_;              // sorted by (a, b)
  std::vector<contact::NarrowPhaseMemory> spare_;  // of pairs that went
  StepThreads* threads_;
  /** Room of one thread. */
  struct Workspace {
    contact::NarrowPhaseWorkspace search;
    contact::SurfaceCover cover;
  };
  std::vector<Workspace> workspaces_;                      // by thread
  std::vector<Recovery> last_apart_;                       // by pair
  std::vector<std::uint8_t> crossed_;                      // by pair: bare meshes cross, also where what fades bears no more
  std::vector<contact::ContactManifold> spare_manifolds_;  // only their memory
};

}  // namespace blem_sim::sim
