// What lies behind a side of a face, seen from above its plane or from below.
#pragma once

#include "kernels/records.h"
#include "mesh_pair.h"
#include "surroundings.h"

namespace blem_sim {

enum class BorderKind : std::uint8_t {
  FLAT,     ///< the plane goes on
  ROUND,    ///< it falls, by so little that the edge and the face behind it take over whatever leaves
  FALLING,  ///< nothing rises out of the plane
  TURNING,  ///< something rises by so little that it takes a contact over that leaves
  RISING
};

/** Of the sides of a face: seen from above its plane, where the normal of its winding points to, [1], and from below [0]; side k goes from
 * corner k to the next. */
struct BorderKinds {
  BorderKind of[2][3];

  /** Does the plane go on beside the face? */
  bool goesOn() const { return of[0][0] == BorderKind::FLAT || of[0][1] == BorderKind::FLAT || of[0][2] == BorderKind::FLAT; }
};
BorderKinds borderKinds(const MeshSide& side, int face, SurroundingsMemory* surroundings);

/** Over which sides contacts may fade: neither over flat nor over round ones, and over turning ones only where another one lets them. */
kernels::OpenSides openSides(const BorderKinds& kinds);

}  // namespace blem_sim
