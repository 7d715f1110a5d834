#include "mesh_files.h"

#include <cstdint>
#include <fstream>
#include <stdexcept>

namespace blem_sim::demo {

namespace {

template <typename Number>
void put(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void putPoint(std::string& bytes, const Vector3& p) {
  for (int i = 0; i < 3; ++i) put(bytes, static_cast<float>(p[i]));
}

void write(const std::string& file, const std::string& bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw std::runtime_error(file + ": cannot be written; give a folder that exists and is writable");
}

}  // namespace

void writePly(const std::string& file, const geometry::TriangleMesh& mesh) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(mesh.elements.size()) +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vector3& v : mesh.vertices) putPoint(bytes, v);
  for (const Vector3i& e : mesh.elements) {
    put(bytes, std::uint8_t{3});
    for (int i = 0; i < 3; ++i) put(bytes, static_cast<std::int32_t>(e[i]));
  }
  write(file, bytes);
}

void writeStl(const std::string& file, const geometry::TriangleMesh& mesh) {
  std::string bytes = "blem_sim demo mesh, metres";
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(mesh.elements.size()));
  for (const Vector3i& e : mesh.elements) {
    const Vector3 &a = mesh.vertices[e[0]], &b = mesh.vertices[e[1]], &c = mesh.vertices[e[2]];
    putPoint(bytes, (b - a).cross(c - a).normalized());
    for (int i = 0; i < 3; ++i) putPoint(bytes, mesh.vertices[e[i]]);
    put(bytes, std::uint16_t{0});
  }
  write(file, bytes);
}

void writePcd(const std::string& file, const std::vector<Vector3>& points) {
  const std::string count = std::to_string(points.size());
  std::string bytes = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
                      count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
  for (const Vector3& p : points) putPoint(bytes, p);
  write(file, bytes);
}

}  // namespace blem_sim::demo
