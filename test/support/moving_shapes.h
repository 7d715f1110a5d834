// Shapes that roll, mesh and hang.
#pragma once

#include <cmath>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim {

/** A ring about z. @param radius [m] of its middle line @param thickness [m] half of it */
inline geometry::TriangleMesh ringMesh(double radius, double thickness, int around, int across) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = 2 * M_PI * i / around, b = 2 * M_PI * j / across, r = radius + thickness * std::cos(b);
      mesh.vertices.emplace_back(r * std::cos(a), r * std::sin(a), thickness * std::sin(b));
    }
  }
  const auto at = [&](int i, int j) { return i % around * across + j % across; };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      mesh.elements.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      mesh.elements.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return mesh;
}

/** A wheel about z with straight teeth. @param root, tip [m] radii between the teeth and at their ends @param width [m] along z */
inline geometry::TriangleMesh gearMesh(int teeth, double root, double tip, double width) {
  geometry::TriangleMesh mesh;
  constexpr int CORNERS = 4;  // of a tooth: two at its root, two at its tip
  constexpr double PLACES[CORNERS] = {-0.28, -0.12, 0.12, 0.28};
  const int count = CORNERS * teeth;
  for (const double z : {-0.5 * width, 0.5 * width}) {
    for (int i = 0; i < count; ++i) {
      const int corner = i % CORNERS;
      const double angle = 2 * M_PI * (i / CORNERS + PLACES[corner]) / teeth, r = corner == 0 || corner == CORNERS - 1 ? root : tip;
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
  const int below = static_cast<int>(mesh.vertices.size()), above = below + 1;
  mesh.vertices.emplace_back(0, 0, -0.5 * width);
  mesh.vertices.emplace_back(0, 0, 0.5 * width);
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    mesh.elements.emplace_back(below, next, i);
    mesh.elements.emplace_back(above, count + i, count + next);
    mesh.elements.emplace_back(i, next, count + next);
    mesh.elements.emplace_back(i, count + next, count + i);
  }
  return mesh;
}

}  // namespace blem_sim
