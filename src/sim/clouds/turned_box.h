// Boxes in other frames.
#pragma once

#include "blem_sim/geometry/types.h"

namespace blem_sim::sim {

/** Box in another frame that holds the box. */
inline Box turned(const Box& box, const Pose& X) {
  Box all;
  for (int corner = 0; corner < 8; ++corner) all.extend(X * box.corner(static_cast<Box::CornerType>(corner)));
  return all;
}

}  // namespace blem_sim::sim
