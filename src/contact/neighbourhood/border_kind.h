// Surroundings of a face's side: another face, a crease, a border; seen from above its plane or from below.
#pragma once

#include "features/mesh_pair.h"
#include "kernels/records.h"
#include "neighbourhood/surroundings.h"

namespace blem_sim::contact {

/** Kinds of the sides of a face, seen from above its plane, where the normal of its winding points to, [1], and from below [0]. Bits k;
 * side k goes from corner k to the next. Behind sides without a bit a face rises so little that it takes over a contact that leaves. */
struct BorderKinds {
  struct Seen {
    std::uint8_t flat;     ///< the plane goes on
    std::uint8_t round;    ///< the surface falls, by so little that the edge and the face behind it take over contacts that leave
    std::uint8_t falling;  ///< nothing rises out of the plane
    std::uint8_t rising;   ///< something rises, and takes nothing over
  } seen[2];
};
BorderKinds borderKinds(const MeshSide& side, int face, SurroundingsMemory* surroundings);

/** Sides over which contacts may fade: neither flat nor round ones, and others only where a falling or rising side lets them. For points
 * without edges only a rising side does: over one that falls no surface of theirs leads on. */
kernels::OpenSides openSides(const BorderKinds& kinds);

}  // namespace blem_sim::contact
