#include "publishers/markers/layer_markers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace blem_sim::node {
namespace {

using geometry::MeshTopology;
using geometry::TriangleMesh;
using visualization_msgs::Marker;

TriangleMesh shellOf(const TriangleMesh& mesh, double r) { return movedShell(mesh, MeshTopology(mesh), r); }

TEST(LayerMarkers, FacesOfABoxMoveOutByTheWidth) {
  const Vector3 size(0.2, 0.4, 0.6);
  const TriangleMesh shell = shellOf(geometry::boxMesh(size), 0.01);
  EXPECT_EQ(shell.elements.size(), 12U);
  const Box bounds = shell.bounds();
  EXPECT_LT((bounds.sizes() - (size + Vector3::Constant(0.02))).norm(), 1e-9);
}

TEST(LayerMarkers, ABoxThatIsInsideOutHasItsLayerOutside) {
  TriangleMesh box = geometry::boxMesh(Vector3(0.2, 0.4, 0.6));
  for (Vector3i& e : box.elements) std::swap(e[0], e[1]);
  EXPECT_NEAR(shellOf(box, 0.01).bounds().sizes().x(), 0.22, 1e-9);
}

TEST(LayerMarkers, AnOpenSheetHasALayerOnBothSides) {
  const TriangleMesh sheet = geometry::gridMesh(1, 1, 4, 4);
  const TriangleMesh shell = shellOf(sheet, 0.01);
  EXPECT_EQ(shell.elements.size(), 2 * sheet.elements.size());
  EXPECT_NEAR(shell.bounds().min().z(), -0.01, 1e-12);
  EXPECT_NEAR(shell.bounds().max().z(), 0.01, 1e-12);
  EXPECT_NEAR(shell.bounds().max().x(), 0.5, 1e-12);
}

TEST(LayerMarkers, FacesOfASoupMoveOnTheirOwn) {
  TriangleMesh soup = geometry::boxMesh(Vector3(0.2, 0.4, 0.6));
  std::swap(soup.elements[3][0], soup.elements[3][1]);
  const TriangleMesh shell = shellOf(soup, 0.01);
  ASSERT_EQ(shell.elements.size(), 24U);
  for (int i = 0; i < 24; ++i) {
    const Vector3 way = shell.vertices[shell.elements[i][0]] - soup.vertices[soup.elements[i % 12][0]];
    EXPECT_NEAR(way.norm(), 0.01, 1e-12);
    EXPECT_NEAR(std::abs(way.dot(MeshTopology::normal(soup, i % 12))), 0.01, 1e-12);
  }
}

TEST(LayerMarkers, AVertexOfASharpSpikeStaysNear) {
  TriangleMesh spike;
  spike.vertices = {{-0.01, -0.01, 0}, {0.01, -0.01, 0}, {0, 0.01, 0}, {0, 0, 1}};
  spike.elements = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  EXPECT_LE(shellOf(spike, 0.01).bounds().max().z(), 1 + 0.02 + 1e-12);
}

TEST(LayerMarkers, ShellsAreTranslucentAndOnlyWhereThereIsAWidth) {
  contact::Collider collider;
  collider.name = "robot::hand";
  collider.geometry = std::make_shared<contact::CollisionGeometry>(std::make_shared<TriangleMesh>(geometry::boxMesh(Vector3::Ones())));
  std_msgs::ColorRGBA colour;
  colour.r = colour.a = 1;
  const MarkerStyle style{"hand", makePose(Vector3(1, 2, 3)), colour, 5};
  EXPECT_TRUE(layerMarkers(collider, style).empty());
  collider.radius = 0.0025;
  const std::vector<Marker> markers = layerMarkers(collider, style);
  ASSERT_EQ(markers.size(), 1U);
  EXPECT_EQ(markers[0].type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(markers[0].header.frame_id, "hand");
  EXPECT_EQ(markers[0].ns, "robot::hand");
  EXPECT_EQ(markers[0].id, 5);
  EXPECT_EQ(markers[0].points.size(), 36U);
  EXPECT_LT(markers[0].color.a, 0.5F);
  EXPECT_LT(markers[0].color.r, 1);
  collider.outside = collider.geometry;
  EXPECT_TRUE(layerMarkers(collider, style).empty()) << "a layer that lies inside ends at the surface that is drawn";
  collider.outside.reset();
  collider.geometry = contact::CollisionGeometry::halfSpace(Vector3::UnitZ(), 0);
  EXPECT_TRUE(layerMarkers(collider, style).empty());
}

}  // namespace
}  // namespace blem_sim::node
