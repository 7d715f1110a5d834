// Content of a mesh or cloud file, before scaling and cleaning.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"
#include "blem_sim/model/cloud.h"

namespace blem_sim::model {

/** Vertices with triangles, segments and points as the file gives them, or bare points, perhaps on a pixel grid. */
struct SurfaceSoup {
  geometry::TriangleMesh mesh;       ///< no elements: a cloud
  int width = 0, height = 1;         ///< > 1 both: vertex (row, column) is row * width + column
  int collapsed = 0;                 ///< faces that name a vertex twice; left out, as they are no segments
  std::optional<Vector3> viewpoint;  ///< [m] of a cloud's sensor, if the file tells it
  std::vector<std::string> notes;    ///< repairs, in words

  bool hasPixelGrid() const { return width > 1 && height > 1; }
};

/** Reserves memory for `more` items, without another copy where many small meshes follow each other. */
template <typename T>
void makeRoom(std::size_t more, std::vector<T>* items) {
  const std::size_t needed = items->size() + more;
  if (needed > items->capacity()) items->reserve(std::max(needed, 2 * items->capacity()));
}

/** Mesh by assimp; binary PLY by readBinaryPly. @param extension "stl", "ply", "obj", "off" or "dae" @throws InputError */
SurfaceSoup readMesh(const std::string& file, const std::string& extension);

/** Cloud by PCL: PCD in all its encodings; points that were not measured stay as NaN. @throws InputError */
SurfaceSoup readPcd(const std::string& file);

/**
 * Triangles from the points of a soup, which keeps its vertices or gets others; the report tells how many. @throws InputError: a mesher
 * that the cloud does not suit, no triangle
 */
void joinCloud(const CloudOptions& options, SurfaceSoup* soup, geometry::MeshReport* report);

}  // namespace blem_sim::model
