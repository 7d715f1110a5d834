// Closed shells by lofting outlines, and the mug.
#pragma once

#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::demo {

/** A thin mug of 80 mm diameter and 95 mm height, its foot's rim in z = 0, handle towards +x: outer side only, no bottom, no inside,
 *  with 0.15 mm of sensor noise. [m] */
geometry::TriangleMesh shellMug();

/** A closed box whose faces are grids. @param size [m] @param cell [m] edge of the grid, rounded so that it fits */
geometry::TriangleMesh gridBox(const Vector3& size, double cell);

struct NamedMesh {
  const char* name;
  geometry::TriangleMesh mesh;
};

/** The links of the demo humanoid, each closed, in its link's frame: x forward, y left, z up, origin in the joint towards the root. */
std::vector<NamedMesh> humanoidShells();

/** The parts of the demo gripper; in a finger's frame the pad's face is y = 0, and it closes towards -y. */
std::vector<NamedMesh> gripperShells();

/** The parts of the demo watcher, each closed: a foot with a mast in the frame of the ground, a neck and a head in their joints' frames. */
std::vector<NamedMesh> watcherShells();

}  // namespace blem_sim::demo
