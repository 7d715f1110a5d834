#include <cmath>

#include "noise.h"
#include "shells.h"

namespace blem_sim::demo {

namespace {

constexpr double RADIUS = 0.040, HEIGHT = 0.095;
constexpr double NOISE = 1.5e-4;  // [m]

// Quads between the points of neighbouring rows. @param wrap the last column meets the first
void appendStrips(geometry::TriangleMesh& mesh, int first, int rows, int columns, bool wrap) {
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column < (wrap ? columns : columns - 1); ++column) {
      const int next = (column + 1) % columns;
      const int a = first + row * columns + column, b = first + row * columns + next, c = b + columns, d = a + columns;
      mesh.elements.emplace_back(a, b, c);
      mesh.elements.emplace_back(a, c, d);
    }
  }
}

}  // namespace

geometry::TriangleMesh shellMug() {
  constexpr int AROUND = 96, UP = 31, ALONG = 41, ACROSS = 12;
  geometry::TriangleMesh mug;
  Noise noise(41);
  for (int row = 0; row < UP; ++row) {
    const double z = HEIGHT * row / (UP - 1);
    for (int i = 0; i < AROUND; ++i) {
      const double angle = 2 * M_PI * i / AROUND, radius = RADIUS + NOISE * noise.normal();
      // The rim stays in its plane, else the mug rocks on three of its points.
      const double height = row == 0 ? 0 : z + NOISE * noise.normal();
      mug.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
    }
  }
  appendStrips(mug, 0, UP, AROUND, true);

  // The handle: a tube of oval section along half an ellipse from wall to wall.
  const int first = static_cast<int>(mug.vertices.size());
  for (int i = 0; i < ALONG; ++i) {
    const double along = M_PI * (static_cast<double>(i) / (ALONG - 1) - 0.5);
    const Vector3 centre(RADIUS - 0.002 + 0.026 * std::cos(along), 0, 0.5 * HEIGHT + 0.030 * std::sin(along));
    const Vector3 outward(std::cos(along), 0, std::sin(along));
    for (int j = 0; j < ACROSS; ++j) {
      const double around = 2 * M_PI * j / ACROSS;
      const Vector3 ring = 0.0035 * std::cos(around) * outward + Vector3(0, 0.0060 * std::sin(around), 0);
      mug.vertices.push_back(centre + ring + NOISE * Vector3(noise.normal(), noise.normal(), noise.normal()));
    }
  }
  appendStrips(mug, first, ALONG, ACROSS, true);
  return mug;
}

}  // namespace blem_sim::demo
