// Content of a mesh or cloud file, before scaling and cleaning.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::model {

/** Vertices with triangles, segments and points as the file gives them, or bare points, perhaps on a pixel grid. */
struct SurfaceSoup {
  geometry::TriangleMesh mesh;     ///< no elements: a cloud
  int width = 0, height = 1;       ///< > 1 both: vertex (row, column) is row * width + column
  int collapsed = 0;               ///< faces that name a vertex twice; left out, as they are no segments
  std::vector<std::string> notes;  ///< repairs, in words
};

/** Mesh by assimp. @param extension "stl", "ply", "obj", "off" or "dae" @throws InputError */
SurfaceSoup readMesh(const std::string& file, const std::string& extension);

/** Cloud by PCL: PCD in all its encodings; points that were not measured stay as NaN. @throws InputError */
SurfaceSoup readPcd(const std::string& file);

/** Triangles between the neighbours of a cloud, edges at most max_edge [m]: on the pixel grid if it has one, else by greedy projection. */
std::vector<Vector3i> meshCloud(const SurfaceSoup& cloud, double max_edge);

}  // namespace blem_sim::model
