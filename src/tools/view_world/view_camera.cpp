#include "view_camera.h"

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/shortest_turn.h"

namespace blem_sim {

namespace {

const Vector3 FROM(0.75, -1, 0.45);       // where the eye is, where z is up
constexpr double ROOM = 1.15;             // about what is framed
constexpr double SMALLEST_RADIUS = 1e-4;  // [m]

}  // namespace

ViewCamera framing(const Box& box, const Vector3& up, double aspect) {
  const double radius = std::max(SMALLEST_RADIUS, 0.5 * box.diagonal().norm());
  const double half_height = 0.5 * FIELD_OF_VIEW;
  const double half_view = std::min(half_height, std::atan(aspect * std::tan(half_height)));
  const Vector3 from = geometry::shortestTurn(Vector3::UnitZ(), up) * FROM.normalized();
  return {box.center() + ROOM * radius / std::sin(half_view) * from, box.center()};
}

}  // namespace blem_sim
