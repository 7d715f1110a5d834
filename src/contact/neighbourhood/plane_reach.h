// Reach of a face's plane beyond the face's sides.
#pragma once

#include "features/mesh_pair.h"

namespace blem_sim::contact {

/** Reach of a face's plane beside the face, but not outside of those of its sides behind which the plane goes on. */
struct PlaneReach {
  double flat;        ///< [m]
  double per_height;  ///< reach added per height, since the plane's faces are parallel but for rounding

  /** No vertex that high [m] lies farther [m] beside the face and over another one of its plane. */
  double at(double height) const { return flat + height * per_height; }
};

/** Reach of a face's plane, infinite if that has many faces: to look at all takes longer than to ask those that are near. */
PlaneReach planeReach(const MeshSide& side, int face);

}  // namespace blem_sim::contact
