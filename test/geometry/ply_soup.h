// Reads the binary PLY files of the pathological meshes as they stand, without any repair.
#pragma once

#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

/** Float vertices x y z, then triangles as a byte 3 and three ints, little-endian: nothing else is understood. */
inline TriangleMesh readPlySoup(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  TriangleMesh soup;
  std::string line;
  while (std::getline(file, line) && line != "end_header") {
    if (line.rfind("element vertex ", 0) == 0) soup.vertices.resize(std::stoul(line.substr(15)));
    if (line.rfind("element face ", 0) == 0) soup.elements.resize(std::stoul(line.substr(13)));
  }
  for (Vector3& v : soup.vertices) {
    float xyz[3];
    file.read(reinterpret_cast<char*>(xyz), sizeof xyz);
    v = Vector3(xyz[0], xyz[1], xyz[2]);
  }
  for (Vector3i& e : soup.elements) {
    std::int32_t indices[3];
    if (file.get() != 3) throw std::runtime_error(path + ": not a triangle");
    file.read(reinterpret_cast<char*>(indices), sizeof indices);
    e = Vector3i(indices[0], indices[1], indices[2]);
  }
  if (!file) throw std::runtime_error(path + ": cut short");
  return soup;
}

}  // namespace blem_sim::geometry
