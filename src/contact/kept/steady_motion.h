// Expected motion of a mesh.
#pragma once

#include "blem_sim/geometry/types.h"

namespace blem_sim::contact {

/** The mean of a mesh's motions from search to search, newer ones counting more: a mesh that trembles about a place goes nowhere. */
class SteadyMotion {
 public:
  /** @param X, Y poses of the mesh at a search and at the next one @param middle of the mesh, its frame */
  void add(const Pose& X, const Pose& Y, const Vector3& middle);
  /** The pose so many searches after X, if the motion goes on. */
  Pose after(double searches, const Pose& X, const Vector3& middle) const;

 private:
  bool known_ = false;
  Vector3 shift_ = Vector3::Zero();  ///< [m] of the middle
  Vector3 turn_ = Vector3::Zero();   ///< [rad] about the middle
};

}  // namespace blem_sim::contact
