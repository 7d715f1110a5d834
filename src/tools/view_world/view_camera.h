// Camera of a picture: a pinhole without distortion.
#pragma once

#include "blem_sim/geometry/types.h"

namespace blem_sim {

/** [rad] height of the view, from its lower to its upper edge. */
constexpr double FIELD_OF_VIEW = 40 * 3.14159265358979323846 / 180;

/** Positions [m] in the world. The target is in the middle of the picture. */
struct ViewCamera {
  Vector3 eye = Vector3::Zero(), target = Vector3::Zero();
};

/** Camera that sees a box whole, from the side of +x and -y, and from above. @param aspect width over height of the picture */
ViewCamera framing(const Box& box, const Vector3& up, double aspect);

}  // namespace blem_sim
