// Messages with sizes and places in them, given bytes that nobody vouches for.
#pragma once

#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/PointCloud2.h>
#include <shape_msgs/Mesh.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "blem_sim/sim/simulator_types.h"
#include "clouds/cloud_message.h"
#include "clouds/grid_message.h"
#include "clouds/mesh_message.h"
#include "fuzz/model_targets.h"

namespace blem_sim {

/** Numbers read one after the other; zeros when there are no bytes left. */
class FuzzBytes {
 public:
  FuzzBytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  template <typename Number>
  Number take() {
    Number number = 0;
    const std::size_t size = std::min(sizeof number, left_);
    if (size > 0) std::memcpy(&number, data_, size);
    data_ += size;
    left_ -= size;
    return number;
  }
  const std::uint8_t* begin() const { return data_; }
  const std::uint8_t* end() const { return data_ + left_; }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

/** A cloud's sizes, fields and points: four numbers of 32 bits, two bytes (byte order, number of fields), ten bytes a field, the points. */
inline sensor_msgs::PointCloud2 cloudFrom(FuzzBytes bytes) {
  static const char* const NAMES[] = {"x", "y", "z", "rgb", ""};
  sensor_msgs::PointCloud2 cloud;
  for (std::uint32_t* number : {&cloud.width, &cloud.height, &cloud.point_step, &cloud.row_step}) *number = bytes.take<std::uint32_t>();
  cloud.is_bigendian = bytes.take<std::uint8_t>() & 1;
  cloud.fields.resize(bytes.take<std::uint8_t>() % 8);
  for (sensor_msgs::PointField& field : cloud.fields) {
    field.name = NAMES[bytes.take<std::uint8_t>() % 5];
    field.offset = bytes.take<std::uint32_t>();
    field.datatype = bytes.take<std::uint8_t>();
    field.count = bytes.take<std::uint32_t>();
  }
  cloud.data.assign(bytes.begin(), bytes.end());
  return cloud;
}

inline void fuzzPoints(const std::uint8_t* data, std::size_t size) {
  const sensor_msgs::PointCloud2 cloud = cloudFrom(FuzzBytes(data, size));
  expectReadOrRefused([&] { node::pointsOf(cloud); });
}

/** Points that are joined to triangles: a byte for the mesher, then a cloud. */
inline void fuzzJoined(const std::uint8_t* data, std::size_t size) {
  FuzzBytes bytes(data, size);
  model::CloudOptions options;
  options.as = model::CloudOptions::As::MESH;
  options.mesher = static_cast<model::CloudOptions::Mesher>(bytes.take<std::uint8_t>() % 5);
  const sensor_msgs::PointCloud2 cloud = cloudFrom(bytes);
  expectReadOrRefused([&] {
    model::SensedCloud sensed(node::pointsOf(cloud, cloud.height > 1));
    if (cloud.height > 1) sensed.width = static_cast<int>(cloud.width), sensed.height = static_cast<int>(cloud.height);
    sensed.viewpoint = Vector3::UnitZ();
    sim::makeCloudSurface(std::move(sensed), options, "fuzz");
  });
}

/** A mesh: a byte for the number of vertices, three numbers of 32 bits each, and three indices of 8 bits a triangle. */
inline void fuzzTriangles(const std::uint8_t* data, std::size_t size) {
  FuzzBytes bytes(data, size);
  shape_msgs::Mesh mesh;
  mesh.vertices.resize(bytes.take<std::uint8_t>());
  for (auto& p : mesh.vertices)
    for (double* coordinate : {&p.x, &p.y, &p.z}) *coordinate = bytes.take<float>();
  while (bytes.begin() != bytes.end()) {
    shape_msgs::MeshTriangle triangle;
    for (auto& corner : triangle.vertex_indices) corner = bytes.take<std::uint8_t>();
    mesh.triangles.push_back(triangle);
  }
  expectReadOrRefused([&] { sim::makeMeshSurface(node::meshOf(mesh), "fuzz"); });
}

/** A grid: sizes of 32 bits, resolution, wall height and origin as numbers of 32 bits, a byte for what is occupied, and the cells. */
inline void fuzzGrid(const std::uint8_t* data, std::size_t size) {
  FuzzBytes bytes(data, size);
  nav_msgs::OccupancyGrid grid;
  grid.info.width = bytes.take<std::uint32_t>();
  grid.info.height = bytes.take<std::uint32_t>();
  grid.info.resolution = bytes.take<float>();
  node::GridWalls walls;
  walls.height = 0.1 + bytes.take<std::uint32_t>() % 100;  // a configuration's, which is checked before
  auto& origin = grid.info.origin;
  for (double* number : {&origin.position.x, &origin.position.y, &origin.position.z, &origin.orientation.w, &origin.orientation.x,
                         &origin.orientation.y, &origin.orientation.z})
    *number = bytes.take<float>();
  walls.occupied = 1 + bytes.take<std::uint8_t>() % 100;
  grid.data.assign(bytes.begin(), bytes.end());
  expectReadOrRefused([&] {
    geometry::TriangleMesh mesh = node::wallsOf(grid, walls);
    if (!mesh.elements.empty()) sim::makeMeshSurface(std::move(mesh), "fuzz");
  });
}

}  // namespace blem_sim
