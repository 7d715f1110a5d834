// Reads binary STL as it stands, without any repair.
#pragma once

#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::contact {

/** 80 bytes of header, a count, then 50 bytes per triangle (normal, three corners, attribute); little-endian floats. */
inline geometry::TriangleMesh readStlSoup(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(80);
  std::uint32_t count = 0;
  file.read(reinterpret_cast<char*>(&count), sizeof count);
  geometry::TriangleMesh soup;
  for (std::uint32_t i = 0; i < count && file; ++i) {
    float numbers[12];
    std::uint16_t attribute;
    file.read(reinterpret_cast<char*>(numbers), sizeof numbers);
    file.read(reinterpret_cast<char*>(&attribute), sizeof attribute);
    const int first = static_cast<int>(soup.vertices.size());
    for (int k = 1; k < 4; ++k) soup.vertices.emplace_back(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
    soup.elements.push_back({first, first + 1, first + 2});
  }
  if (!file) throw std::runtime_error(path + ": cut short");
  return soup;
}

}  // namespace blem_sim::contact
