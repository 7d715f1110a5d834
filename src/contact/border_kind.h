// What lies behind a side of a face, seen from above its plane or from below.
#pragma once

#include "kernels/records.h"
#include "mesh_pair.h"
#include "surroundings.h"

namespace blem_sim {

/** Of the sides of a face, seen from above its plane, where the normal of its winding points to, [1], and from below [0]. Bits k; side k
 * goes from corner k to the next. Of the other sides something rises so little that it takes a contact over that leaves. */
struct BorderKinds {
  struct Seen {
    std::uint8_t flat;     ///< the plane goes on
    std::uint8_t round;    ///< it falls, by so little that the edge and the face behind it take over whatever leaves
    std::uint8_t falling;  ///< nothing rises out of the plane
    std::uint8_t rising;   ///< something rises, and takes nothing over
  } seen[2];
};
BorderKinds borderKinds(const MeshSide& side, int face, SurroundingsMemory* surroundings);

/** Over which sides contacts may fade: neither over flat nor over round ones, and over turning ones only where another one lets them. Of
 * points without edges none does where a border falls: no surface of theirs leads on. */
kernels::OpenSides openSides(const BorderKinds& kinds);

}  // namespace blem_sim
