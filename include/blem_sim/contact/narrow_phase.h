#pragma once

#include <memory>

#include "blem_sim/contact/broad_phase.h"
#include "blem_sim/contact/collider.h"
#include "blem_sim/contact/manifold.h"

namespace blem_sim::contact {

class NarrowPhaseMemory;
class NarrowPhaseWorkspace;

/** A collider and where its geometry is. */
struct PlacedCollider {
  const Collider& collider;
  const Pose& X_WC;
};

/** Contacts that are asked for, and what is known of the pair. */
struct NarrowPhaseQuestion {
  double margin = 0;                    ///< [m] largest gap of contacts beyond the layers
  const Pose* X_AB_apart = nullptr;     ///< geometry of B in A's where they last did not cross; null: unknown, then the smaller body's
                                        ///< middle is on its own side
  NarrowPhaseMemory* memory = nullptr;  ///< of this pair alone, or null
};

/** Memory of the search for the contacts of one pair, from step to step. It saves time and changes no result: it is no state. */
class NarrowPhaseMemory {
 public:
  NarrowPhaseMemory();
  ~NarrowPhaseMemory();
  NarrowPhaseMemory(NarrowPhaseMemory&&) noexcept;
  NarrowPhaseMemory& operator=(NarrowPhaseMemory&&) noexcept;

 private:
  friend void narrowPhase(const PlacedCollider& a, const PlacedCollider& b, const NarrowPhaseQuestion& asked,
                          NarrowPhaseWorkspace* workspace, ContactManifold* out);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/** Room for one search at a time, and descriptions of the leaves that searches looked at lately (at most 100 MB): whoever searches has one
 * per thread. It saves time and changes no result. */
class NarrowPhaseWorkspace {
 public:
  NarrowPhaseWorkspace();
  ~NarrowPhaseWorkspace();
  NarrowPhaseWorkspace(NarrowPhaseWorkspace&&) noexcept;
  NarrowPhaseWorkspace& operator=(NarrowPhaseWorkspace&&) noexcept;

 private:
  friend void narrowPhase(const PlacedCollider& a, const PlacedCollider& b, const NarrowPhaseQuestion& asked,
                          NarrowPhaseWorkspace* workspace, ContactManifold* out);
  struct Impl;
  std::unique_ptr<Impl> impl_;  // none before the first search
};

/**
 * All contacts of one pair: every pair of simplices (vertex-face, edge-edge, vertex-edge, vertex-vertex, each asked once by its one owner)
 * whose closest points lie inside both and are within rA + rB + margin [Hauser 2013, Eq. 6 and Fig. 5]. Flat features own nothing,
 * coincident contacts are merged. Where a closest point leaves its face or edge and nothing takes the contact over exactly (a concave edge,
 * a vertex whose surface comes closer beside it), its depth fades by 2 um per um outside. Complete: the smallest distance among them is the
 * distance of the meshes. Independent of the order of triangles and of their winding; in an order that the meshes alone decide. Where bare
 * meshes cross, contacts beside these are the fallback's: one per crossing of an edge and a face, whose depth grows past rA + rB with the
 * way that has to be taken back, and whose direction is the way back to where the pair was apart.
 * @param out overwritten; contacts in the world frame
 */
void narrowPhase(const PlacedCollider& a, const PlacedCollider& b, const NarrowPhaseQuestion& asked, NarrowPhaseWorkspace* workspace,
                 ContactManifold* out);

}  // namespace blem_sim::contact
