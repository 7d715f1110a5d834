// Values that many tests share.
#pragma once

#include "blem_sim/geometry/types.h"

namespace blem_sim {

constexpr double DT = 1e-3;         // [s]
constexpr double G = 9.81;          // [m/s^2]
const Vector3 GRAVITY(0, 0, -G);    // [m/s^2]
const Vector3 CUBE(0.1, 0.1, 0.1);  // [m] edges

}  // namespace blem_sim
