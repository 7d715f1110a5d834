#pragma once

#include <memory>

#include "blem_sim/contact/broad_phase.h"
#include "blem_sim/contact/collider.h"
#include "blem_sim/contact/manifold.h"

namespace blem_sim::contact {

/** Memory of the search for the contacts of one pair, from step to step. It saves time and changes no result: it is no state. */
class NarrowPhaseMemory {
 public:
  NarrowPhaseMemory();
  ~NarrowPhaseMemory();
  NarrowPhaseMemory(NarrowPhaseMemory&&) noexcept;
  NarrowPhaseMemory& operator=(NarrowPhaseMemory&&) noexcept;

 private:
  friend void narrowPhase(const Collider&, const Pose&, const Collider&, const Pose&, double, ContactManifold*, const Pose*,
                          NarrowPhaseMemory*);
  struct Impl;
  std::unique_ptr<Impl> impl_;
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
 * @param memory of this pair alone, or null
 * @param X_AB_apart geometry of B in A's where they last did not cross; null: unknown, then the smaller body's middle is on its own side
 */
void narrowPhase(const Collider& a, const Pose& X_WA, const Collider& b, const Pose& X_WB, double margin, ContactManifold* out,
                 const Pose* X_AB_apart = nullptr, NarrowPhaseMemory* memory = nullptr);

}  // namespace blem_sim::contact
