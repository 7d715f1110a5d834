// Binary files of meshes and clouds.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::demo {

/** Each writes little-endian float coordinates [m]. @throws std::runtime_error naming the file if it cannot be written */
void writePly(const std::string& file, const geometry::TriangleMesh& mesh);
void writeStl(const std::string& file, const geometry::TriangleMesh& mesh);
void writePcd(const std::string& file, const std::vector<Vector3>& points);

}  // namespace blem_sim::demo
