// Contacts of a state.
#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"
#include "contacts/search/crossing_history.h"
#include "contacts/search/flush_surfaces.h"
#include "contacts/search/pair_watch.h"

namespace blem_sim::sim {

/**
 * Contacts of a state before reduction, as PairSearches finds them. They are a function of the state and of the crossings alone, so those
 * found at the end of an accepted step serve the next one, and after a restore they are found anew, the same.
 */
struct FoundContacts {
  bool known = false;  ///< false: bodies or geometry changed other than by a step, so only the crossings count
  WatchedPairs watched;
  std::vector<contact::ContactManifold> manifolds;  ///< sorted by (a, b), none empty
  std::vector<double> depths;                       ///< [m] of each manifold's deepest contact
  CrossingHistory crossings;                        ///< pairs that cross, or did and are not apart yet
  FlushSurfaces flush;                              ///< static surfaces that lie beside each other

  /** [m] @param manifold one of manifolds */
  double depthOf(const contact::ContactManifold& manifold) const { return depths[&manifold - manifolds.data()]; }
};

}  // namespace blem_sim::sim
