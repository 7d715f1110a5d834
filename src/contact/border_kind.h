// What lies behind a side of a face, seen from above its plane or from below.
#pragma once

#include "kernels/records.h"
#include "mesh_pair.h"

namespace blem_sim {

enum class BorderKind : std::uint8_t {
  FLAT,     ///< the plane goes on
  ROUND,    ///< it falls, by so little that the edge and the face behind it take over whatever leaves
  FALLING,  ///< nothing rises out of the plane
  TURNING,  ///< something rises by so little that it takes a contact over that leaves
  RISING
};

/** Of the element's side k (corners k and k + 1). @param above from where the normal of its winding points to */
BorderKind borderKind(const MeshSide& side, int face, int k, bool above);

/** Over which sides contacts may fade: neither over flat nor over round ones. */
kernels::OpenSides openSides(const MeshSide& side, int face);

}  // namespace blem_sim
