#include "publishers/markers/surface_markers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>

#include "support/temporary_folder.h"

namespace blem_sim::node {
namespace {

using visualization_msgs::Marker;

contact::Collider colliderOf(const geometry::TriangleMesh& mesh, double radius) {
  contact::Collider collider;
  collider.name = "thing";
  collider.geometry = std::make_shared<contact::CollisionGeometry>(std::make_shared<geometry::TriangleMesh>(mesh));
  collider.radius = radius;
  return collider;
}

std::vector<Marker> markersOf(const contact::Collider& collider) {
  return surfaceMarkers(collider, {"world", makePose(Vector3(1, 2, 3)), std_msgs::ColorRGBA(), 5});
}

TEST(SurfaceMarkers, AMeshIsOneMarker) {
  const geometry::TriangleMesh grid = geometry::gridMesh(1, 1, 200, 250);
  ASSERT_EQ(grid.elements.size(), MOST_TRIANGLES);
  const std::vector<Marker> markers = markersOf(colliderOf(grid, 0.0025));
  ASSERT_EQ(markers.size(), 1U);
  EXPECT_EQ(markers[0].points.size(), 3 * MOST_TRIANGLES);
}

TEST(SurfaceMarkers, HugeMeshesAreSplitAndNothingIsLost) {
  const geometry::TriangleMesh grid = geometry::gridMesh(1, 1, 300, 400);
  const std::vector<Marker> markers = markersOf(colliderOf(grid, 0.0025));
  ASSERT_EQ(markers.size(), 3U);
  std::size_t corners = 0;
  std::set<int> ids;
  for (const Marker& marker : markers) {
    EXPECT_EQ(marker.type, Marker::TRIANGLE_LIST);
    EXPECT_EQ(marker.points.size() % 3, 0U);
    EXPECT_LE(marker.points.size(), 3 * MOST_TRIANGLES);
    EXPECT_EQ(marker.pose.position.z, 3);
    corners += marker.points.size();
    ids.insert(marker.id);
  }
  EXPECT_EQ(corners, 3 * grid.elements.size());
  EXPECT_EQ(ids.size(), markers.size());
  EXPECT_EQ(*ids.begin(), 5);
}

sim::SurfaceFile fileNamed(const TemporaryFolder& folder, const std::string& name, const std::string& content) {
  const std::string path = folder.write(name, content);
  return {path, "file://" + path, Vector3(1, 2, 3)};
}

TEST(SurfaceMarkers, AHugeMeshIsTheFileItCameFrom) {
  const TemporaryFolder folder;
  MarkerStyle style{"world", makePose(Vector3(1, 2, 3)), std_msgs::ColorRGBA(), 5};
  style.file = fileNamed(folder, "terrain.stl", std::string(84, '\0'));
  const std::vector<Marker> markers = surfaceMarkers(colliderOf(geometry::gridMesh(1, 1, 300, 400), 0), style);
  ASSERT_EQ(markers.size(), 1U);
  EXPECT_EQ(markers[0].type, Marker::MESH_RESOURCE);
  EXPECT_EQ(markers[0].mesh_resource, style.file->uri);
  EXPECT_EQ(markers[0].scale.y, 2);
  EXPECT_EQ(markers[0].pose.position.z, 3);
  const std::vector<Marker> small = surfaceMarkers(colliderOf(geometry::gridMesh(1, 1, 20, 20), 0), style);
  ASSERT_EQ(small.size(), 1U);
  EXPECT_EQ(small[0].type, Marker::TRIANGLE_LIST);
}

TEST(SurfaceMarkers, FilesThatRvizDoesNotReadAreSentAsLists) {
  const TemporaryFolder folder;
  EXPECT_TRUE(rvizReads(fileNamed(folder, "binary.stl", std::string(84, ' '))));
  EXPECT_TRUE(rvizReads(fileNamed(folder, "mesh.ply", "ply\n")));
  EXPECT_TRUE(rvizReads(fileNamed(folder, "mesh.obj", "v 0 0 0\n")));
  EXPECT_FALSE(rvizReads(fileNamed(folder, "ascii.stl", "solid ascii\n")));
  EXPECT_FALSE(rvizReads(fileNamed(folder, "mesh.off", "OFF\n")));
  EXPECT_FALSE(rvizReads(fileNamed(folder, "my mesh.ply", "ply\n")));
  EXPECT_FALSE(rvizReads({folder.path("gone.stl"), "file:///gone.stl", Vector3::Ones()}));
}

TEST(SurfaceMarkers, PointsOfACloudHaveTheColoursOfTheirHeightsInTheWorld) {
  geometry::TriangleMesh cloud;
  for (int i = 0; i < 70000; ++i) {
    cloud.vertices.emplace_back(0.001 * i, 0, 0);
    cloud.elements.emplace_back(i, i, i);
  }
  const Pose X_WC = makePose(Vector3(1, 2, 3), Vector3(0, -M_PI_2, 0));  // the cloud's x is up
  const std::vector<Marker> markers = surfaceMarkers(colliderOf(cloud, 0.004), {"world", X_WC, std_msgs::ColorRGBA(), 0, Vector3::UnitZ()});
  ASSERT_EQ(markers.size(), 1U);
  ASSERT_EQ(markers[0].colors.size(), markers[0].points.size());
  const auto &lowest = markers[0].colors.front(), &highest = markers[0].colors.back();
  EXPECT_GT(lowest.b, lowest.r);
  EXPECT_GT(highest.r, highest.b);
  EXPECT_EQ(lowest.a, 1);
  EXPECT_TRUE(markersOf(colliderOf(cloud, 0.004)).front().colors.empty());
}

TEST(SurfaceMarkers, PointsAreSpheresOfTheirRadius) {
  const std::vector<Marker> markers = markersOf(colliderOf(geometry::pointMesh(Vector3(1, 0, 0)), 0.004));
  ASSERT_EQ(markers.size(), 1U);
  EXPECT_EQ(markers[0].type, Marker::SPHERE_LIST);
  EXPECT_EQ(markers[0].scale.x, 0.008);
  ASSERT_EQ(markers[0].points.size(), 1U);
  EXPECT_EQ(markers[0].points[0].x, 1);
}

TEST(SurfaceMarkers, ManyPointsAreNoSpheres) {
  geometry::TriangleMesh cloud;
  for (int i = 0; i < 70000; ++i) {
    cloud.vertices.emplace_back(1e-3 * (i % 300), 1e-3 * (i / 300), 0);
    cloud.elements.emplace_back(i, i, i);
  }
  std::size_t points = 0;
  for (const Marker& marker : markersOf(colliderOf(cloud, 0.004))) {
    EXPECT_EQ(marker.type, Marker::POINTS);
    points += marker.points.size();
  }
  EXPECT_EQ(points, 70000U);
}

TEST(SurfaceMarkers, SegmentsAreLines) {
  const std::vector<Marker> markers = markersOf(colliderOf(geometry::segmentMesh(Vector3(0, 0, 0), Vector3(0, 0, 1)), 0.01));
  ASSERT_EQ(markers.size(), 1U);
  EXPECT_EQ(markers[0].type, Marker::LINE_LIST);
  ASSERT_EQ(markers[0].points.size(), 2U);
  EXPECT_EQ(markers[0].points[1].z, 1);
}

TEST(SurfaceMarkers, AHalfSpaceIsASquareInItsPlane) {
  contact::Collider collider;
  const Vector3 normal = Vector3(1, 2, 3).normalized();
  collider.geometry = contact::CollisionGeometry::halfSpace(normal, 0.7);
  const std::vector<Marker> markers = markersOf(collider);
  ASSERT_EQ(markers.size(), 1U);
  ASSERT_EQ(markers[0].points.size(), 6U);
  for (const auto& p : markers[0].points) EXPECT_NEAR(normal.dot(Vector3(p.x, p.y, p.z)), 0.7, 1e-12);
}

}  // namespace
}  // namespace blem_sim::node
