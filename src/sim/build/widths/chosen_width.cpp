#include "build/widths/chosen_width.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace blem_sim::sim {
namespace {

constexpr double DEVIATIONS = 3;
constexpr double SPEED = 1;  // [m/s]
constexpr double SAGS = 2;   // springs give way up to 0.8 of the layer
constexpr double PART_OF_SIDE = 0.05;
constexpr double MOST_OF_ENVIRONMENT = 0.005;  // [m]
constexpr double MILLI = 1e-3;

}  // namespace

double smallestSide(const geometry::TriangleMesh& mesh, bool closed) {
  const auto box = mesh.bounds();
  std::array<double, 3> sides;
  for (int axis = 0; axis < 3; ++axis) sides[axis] = box.max()[axis] - box.min()[axis];
  std::sort(sides.begin(), sides.end());
  return closed ? sides[0] : sides[1];
}

ChosenWidth chosenWidth(const WidthNeeds& needs) {
  ChosenWidth chosen{DEVIATIONS * needs.noise, "three deviations of its noise"};
  const auto raise = [&chosen](double width, const char* why) {
    if (width > chosen.width) chosen = {width, why};
  };
  if (needs.moves) raise(SPEED * needs.time_step, "the way of 1 m/s in a time step");
  if (needs.moves) raise(SAGS * needs.weight / needs.stiffness, "twice what its weight presses its surface in");
  if (!(chosen.width > 0)) return {0, "its noise is nothing, or cannot be told"};
  const double cap = !needs.moves ? MOST_OF_ENVIRONMENT : needs.side > 0 ? PART_OF_SIDE * needs.side : chosen.width;
  if (chosen.width <= cap) return chosen;
  const char* capped = needs.moves ? "a twentieth of its smallest side" : "the most for an environment";
  return {cap, fmt::format("{}; {} would be {:.3g} mm", capped, chosen.why, chosen.width / MILLI)};
}

}  // namespace blem_sim::sim
