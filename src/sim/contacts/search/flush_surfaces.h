// Environments that lie flush beside each other have the contacts of one mesh.
#pragma once

#include <vector>

#include "blem_sim/contact/broad_phase.h"
#include "blem_sim/contact/manifold.h"
#include "blem_sim/contact/surface_cover.h"
#include "clouds/fading_points.h"
#include "contacts/search/pair_watch.h"

namespace blem_sim::sim {

/** Static colliders near each moving one: where there are several, their surfaces may go over into each other. */
class FlushSurfaces {
 public:
  /** @param pairs of the search at hand @param fading surfaces that fade are left out */
  void watch(const std::vector<contact::Collider>& colliders, const std::vector<WatchedPair>& pairs, const FadingPoints& fading);
  /** Takes from a pair's contacts with a static surface those that others cover. @param cover work space, of one call at a time */
  void dropCovered(const std::vector<contact::Collider>& colliders, const std::vector<contact::ColliderMotion>& motion,
                   contact::SurfaceCover* cover, contact::ContactManifold* manifold) const;

 private:
  struct Neighbour {
    int moving, fixed;  // colliders
  };
  std::vector<Neighbour> neighbours_;  // of moving colliders with several, sorted
};

}  // namespace blem_sim::sim
