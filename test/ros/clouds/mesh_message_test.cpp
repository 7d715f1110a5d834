// Meshes and occupancy grids of messages: triangles, walls, and fields that lie.
#include "clouds/mesh_message.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "blem_sim/geometry/mesh_topology.h"
#include "clouds/grid_message.h"
#include "support/input_errors.h"

namespace blem_sim::node {
namespace {

shape_msgs::Mesh square() {
  shape_msgs::Mesh mesh;
  mesh.vertices.resize(5);
  mesh.vertices[1].x = mesh.vertices[2].x = mesh.vertices[2].y = mesh.vertices[3].y = 1;
  mesh.vertices[4].z = NAN;  // no triangle's
  mesh.triangles.resize(3);
  mesh.triangles[0].vertex_indices = {0, 1, 2};
  mesh.triangles[1].vertex_indices = {0, 2, 3};
  mesh.triangles[2].vertex_indices = {0, 2, 2};
  return mesh;
}

TEST(MeshMessage, TrianglesWithAnAreaAreRead) {
  const geometry::TriangleMesh mesh = meshOf(square());
  ASSERT_EQ(mesh.elements.size(), 2u);
  EXPECT_EQ(mesh.elements[1], Vector3i(0, 2, 3));
  EXPECT_EQ(mesh.vertices[2], Vector3(1, 1, 0));
}

TEST(MeshMessage, LiesAreRefusedInOneLine) {
  const auto refusalOf = [](const shape_msgs::Mesh& mesh) { return refusal([&] { meshOf(mesh); }); };
  shape_msgs::Mesh lie = square();
  lie.triangles[1].vertex_indices[2] = 5;
  EXPECT_TRUE(isOneLineWith(refusalOf(lie), {"triangles[1]", "5", "out of range"}));
  lie.triangles[1].vertex_indices[2] = std::numeric_limits<std::uint32_t>::max();
  EXPECT_TRUE(isOneLineWith(refusalOf(lie), {"triangles[1]", "out of range"}));
  lie.triangles[1].vertex_indices[2] = 4;
  EXPECT_TRUE(isOneLineWith(refusalOf(lie), {"triangles[1]", "vertices[4]", "finite"}));
  lie.triangles.clear();
  EXPECT_TRUE(isOneLineWith(refusalOf(lie), {"triangles", "none"}));
}

/** Rows of cells, the lowest y first; # is occupied, ? unknown. */
nav_msgs::OccupancyGrid gridOf(const std::vector<std::string>& rows) {
  nav_msgs::OccupancyGrid grid;
  grid.info.resolution = 0.5F;
  grid.info.width = static_cast<std::uint32_t>(rows[0].size());
  grid.info.height = static_cast<std::uint32_t>(rows.size());
  grid.info.origin.orientation.w = 1;
  for (const std::string& row : rows)
    for (const char cell : row) grid.data.push_back(cell == '#' ? 50 : cell == '?' ? -1 : 49);
  return grid;
}

/** Area [m^2] of a mesh's triangles, by the direction of their normals. */
double areaTowards(const geometry::TriangleMesh& mesh, const Vector3& direction) {
  double area = 0;
  for (const Vector3i& e : mesh.elements) {
    const Vector3 square = (mesh.vertices[e[1]] - mesh.vertices[e[0]]).cross(mesh.vertices[e[2]] - mesh.vertices[e[0]]);
    if (square.normalized().dot(direction) > 0.999) area += 0.5 * square.norm();
  }
  return area;
}

TEST(GridMessage, OneCellIsABoxWithoutABottom) {
  const geometry::TriangleMesh mesh = wallsOf(gridOf({"...", ".#?", "..."}), {50, 2});
  EXPECT_EQ(mesh.elements.size(), 10u);
  EXPECT_EQ(mesh.bounds().min(), Vector3(0.5, 0.5, 0));
  EXPECT_EQ(mesh.bounds().max(), Vector3(1, 1, 2));
  for (const Vector3& side : {Vector3(1, 0, 0), Vector3(-1, 0, 0), Vector3(0, 1, 0), Vector3(0, -1, 0)})
    EXPECT_DOUBLE_EQ(areaTowards(mesh, side), 1);
  EXPECT_DOUBLE_EQ(areaTowards(mesh, Vector3::UnitZ()), 0.25);
  EXPECT_DOUBLE_EQ(areaTowards(mesh, -Vector3::UnitZ()), 0);
}

TEST(GridMessage, RunsAreMergedAndNoWallIsInside) {
  // A block to the border: a top and four sides, ten triangles.
  EXPECT_EQ(wallsOf(gridOf({"###", "###"}), {}).elements.size(), 10u);
  // An L: two tops, six sides.
  const geometry::TriangleMesh corner = wallsOf(gridOf({"#..", "#..", "###"}), {});
  EXPECT_EQ(corner.elements.size(), 16u);
  EXPECT_DOUBLE_EQ(areaTowards(corner, Vector3::UnitX()), 1.5);
  EXPECT_DOUBLE_EQ(areaTowards(corner, -Vector3::UnitY()), 1.5);
  EXPECT_DOUBLE_EQ(areaTowards(corner, Vector3::UnitZ()), 5 * 0.25);
}

TEST(GridMessage, CellsFromTheValueOnAreWalls) {
  nav_msgs::OccupancyGrid grid = gridOf({"..#"});
  EXPECT_EQ(wallsOf(grid, {50, 1}).bounds().min().x(), 1);
  EXPECT_EQ(wallsOf(grid, {49, 1}).bounds().min().x(), 0);
}

TEST(GridMessage, ItsOriginTurnsAndMovesIt) {
  nav_msgs::OccupancyGrid grid = gridOf({"#."});
  grid.info.origin.position.x = 2;
  grid.info.origin.position.z = -1;
  grid.info.origin.orientation.w = grid.info.origin.orientation.z = std::sqrt(0.5);  // x along the map's y
  const Box box = wallsOf(grid, {}).bounds();
  EXPECT_TRUE(box.min().isApprox(Vector3(1.5, 0, -1), 1e-12));
  EXPECT_TRUE(Vector3(box.max() - Vector3(2, 0.5, 0)).isZero(1e-12));
}

TEST(GridMessage, LiesAreRefusedInOneLine) {
  const auto refusalOf = [](const nav_msgs::OccupancyGrid& grid) { return refusal([&] { wallsOf(grid, {}); }); };
  for (const float resolution : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    nav_msgs::OccupancyGrid lie = gridOf({"#."});
    lie.info.resolution = resolution;
    EXPECT_TRUE(isOneLineWith(refusalOf(lie), {"info.resolution"})) << resolution;
  }
  for (const auto& [width, height] :
       {std::make_pair(2u, 2u), std::make_pair(0u, 0u), std::make_pair(1u << 31, 2u), std::make_pair(~0u, ~0u)}) {
    nav_msgs::OccupancyGrid lie = gridOf({"#."});
    lie.info.width = width;
    lie.info.height = height;
    EXPECT_TRUE(isOneLineWith(refusalOf(lie), {"info.width", "2 cells"})) << width;
  }
  nav_msgs::OccupancyGrid lie = gridOf({"#."});
  lie.info.origin.orientation.w = 0;
  EXPECT_TRUE(isOneLineWith(refusalOf(lie), {"info.origin"}));
}

TEST(GridMessage, WithoutAWallHasNoTriangle) { EXPECT_TRUE(wallsOf(gridOf({".?"}), {}).elements.empty()); }

}  // namespace
}  // namespace blem_sim::node
