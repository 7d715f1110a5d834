// Flat shapes that bulge by micrometres and end in a sharp outline.
#pragma once

#include <cmath>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

/** A plano-convex lens: z from 0 at the flat side's rim to height + sag in the middle. @param sag [m] of the bulge */
inline TriangleMesh lensMesh(double radius, double height, double sag, int rings, int sides) {
  TriangleMesh mesh;
  const auto place = [&](int ring, int side, double z) {
    const double r = radius * ring / rings, angle = 2 * M_PI * side / sides;
    mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  };
  mesh.vertices.emplace_back(0, 0, height + sag);
  for (int ring = 1; ring <= rings; ++ring) {
    const double part = static_cast<double>(ring) / rings;
    for (int side = 0; side < sides; ++side) place(ring, side, height + sag * (1 - part * part));
  }
  for (int side = 0; side < sides; ++side) place(rings, side, 0);
  const int foot = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, 0);
  for (int side = 0; side < sides; ++side) {
    const int next = (side + 1) % sides;
    const auto at = [&](int ring, int s) { return ring == 0 ? 0 : 1 + (ring - 1) * sides + s; };
    mesh.elements.emplace_back(0, at(1, side), at(1, next));
    for (int ring = 1; ring <= rings; ++ring) {  // the last one is the edge
      mesh.elements.emplace_back(at(ring, side), at(ring + 1, side), at(ring + 1, next));
      mesh.elements.emplace_back(at(ring, side), at(ring + 1, next), at(ring, next));
    }
    mesh.elements.emplace_back(foot, at(rings + 1, next), at(rings + 1, side));
  }
  return mesh;
}

}  // namespace blem_sim::geometry
