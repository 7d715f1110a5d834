#include "blem_sim/geometry/mesh_shrinking.h"

#include <gtest/gtest.h>

#include "blem_sim/geometry/cylinder.h"

namespace blem_sim::geometry {
namespace {

constexpr double R = 0.0025;

TEST(MeshShrinking, BoxOfAnyTessellationShrinksByItsLayerOnEverySide) {
  for (const int level : {0, 1, 3}) {
    const TriangleMesh box = subdivided(boxMesh({0.1, 0.2, 0.05}), level);
    MeshShrinking what;
    const TriangleMesh shrunk = shrinkMesh(box, R, &what);
    EXPECT_EQ(what.refused, "");
    EXPECT_EQ(what.held_back, 0);
    EXPECT_LT(what.excess, 1e-12);
    EXPECT_LT(what.shortfall, 1e-12);
    EXPECT_NEAR((shrunk.bounds().sizes() - Vector3(0.095, 0.195, 0.045)).norm(), 0, 1e-12) << level;
    EXPECT_EQ(shrunk.elements, box.elements);
  }
}

TEST(MeshShrinking, InsideOutIsShrunkTheSame) {
  TriangleMesh box = boxMesh({0.1, 0.1, 0.1});
  for (Vector3i& e : box.elements) std::swap(e[1], e[2]);
  MeshShrinking what;
  EXPECT_NEAR((shrinkMesh(box, R, &what).bounds().sizes() - Vector3::Constant(0.095)).norm(), 0, 1e-12);
}

TEST(MeshShrinking, SphereAndCylinderKeepTheirOutside) {
  MeshShrinking what;
  const TriangleMesh ball = shrinkMesh(icosphereMesh(0.05, 3), R, &what);
  EXPECT_EQ(what.held_back, 0);
  EXPECT_LT(what.excess + what.shortfall, 1e-4 * R + 1e-5);
  EXPECT_NEAR(ball.bounds().sizes().x(), 0.1 - 2 * R, 2e-5);
  const TriangleMesh cylinder = shrinkMesh(cylinderMesh(0.05, 0.2), R, &what);
  EXPECT_LT(what.excess + what.shortfall, 1e-9);
  EXPECT_NEAR(cylinder.bounds().sizes().z(), 0.2 - 2 * R, 1e-12);
}

TEST(MeshShrinking, ACylindersCoreLacksALayerOnEverySide) {
  const Pose X = makePose({1, 2, 3}, {0.4, 0.5, 0.6});
  const TriangleMesh mesh = transformed(cylinderMesh(0.05, 0.2), X);
  const std::optional<Cylinder> cylinder = cylinderBehind(mesh);
  ASSERT_TRUE(cylinder);
  EXPECT_NEAR(widestLayerInside(*cylinder), 0.025, 1e-12);
  const CylinderCore core = coreOf(mesh, *cylinder, R);
  const TriangleMesh expected = transformed(cylinderMesh(0.05 - R, 0.2 - 2 * R), X);
  for (std::size_t v = 0; v < expected.vertices.size(); ++v) EXPECT_NEAR((core.mesh.vertices[v] - expected.vertices[v]).norm(), 0, 1e-12);
  EXPECT_EQ(core.mesh.elements, expected.elements);
  EXPECT_NEAR(core.cylinder.radius, 0.05 - R, 1e-12);
  EXPECT_NEAR(core.cylinder.half_length, 0.1 - R, 1e-12);
}

TEST(MeshShrinking, SaysWhyItCannot) {
  MeshShrinking what;
  const TriangleMesh sheet = gridMesh(1, 1, 3, 3);
  EXPECT_EQ(shrinkMesh(sheet, R, &what).vertices, sheet.vertices);
  EXPECT_NE(what.refused.find("open"), std::string::npos);
  EXPECT_EQ(what.excess, R);
  TriangleMesh mixed = boxMesh({1, 1, 1});
  std::swap(mixed.elements[0][1], mixed.elements[0][2]);
  shrinkMesh(mixed, R, &what);
  EXPECT_NE(what.refused.find("wound"), std::string::npos);
  shrinkMesh(segmentMesh({0, 0, 0}, {1, 0, 0}), R, &what);
  EXPECT_NE(what.refused, "");
}

/** A plate thinner than two layers, alone or as a part of something thicker, is not turned inside out. */
TEST(MeshShrinking, ThinPartsAreHeldBack) {
  MeshShrinking what;
  const TriangleMesh plate = shrinkMesh(subdivided(boxMesh({0.1, 0.1, 0.004}), 2), R, &what);
  EXPECT_EQ(what.refused, "");
  EXPECT_GT(what.held_back, 0);
  EXPECT_GT(what.excess, 0.0005);
  EXPECT_LE(what.excess, R);
  MassProperties mass;
  EXPECT_TRUE(massFromVolume(plate, 1, &mass));
  EXPECT_GT(plate.bounds().sizes().z(), 0);
  EXPECT_LT(plate.bounds().sizes().z(), 0.004);
  // A ball smaller than its layer.
  const TriangleMesh ball = shrinkMesh(icosphereMesh(0.002, 2), R, &what);
  EXPECT_TRUE(massFromVolume(ball, 1, &mass));
  EXPECT_GT(what.excess, 0);
}

/** Parts that stick in each other, as in a CAD model, shrink each for itself. */
TEST(MeshShrinking, PartsThatCrossedBeforeAreNoHindrance) {
  TriangleMesh mesh = boxMesh({0.1, 0.1, 0.1});
  const TriangleMesh rod = boxMesh({0.03, 0.03, 0.3});
  for (const Vector3& v : rod.vertices) mesh.vertices.push_back(v);
  for (const Vector3i& e : rod.elements) mesh.elements.push_back(e + Vector3i::Constant(8));
  MeshShrinking what;
  const TriangleMesh shrunk = shrinkMesh(mesh, R, &what);
  EXPECT_EQ(what.held_back, 0);
  EXPECT_NEAR((shrunk.bounds().sizes() - Vector3(0.095, 0.095, 0.295)).norm(), 0, 1e-12);
}

TEST(MeshShrinking, SpikesMoveByABoundedLength) {
  TriangleMesh spike;
  spike.vertices = {{0, 0, 0.5}, {0.02, 0, 0}, {-0.01, 0.017, 0}, {-0.01, -0.017, 0}};
  spike.elements = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  MeshShrinking what;
  const TriangleMesh shrunk = shrinkMesh(spike, R, &what);
  EXPECT_EQ(what.refused, "");
  for (std::size_t v = 0; v < spike.vertices.size(); ++v) EXPECT_LE((shrunk.vertices[v] - spike.vertices[v]).norm(), 3 * R + 1e-12);
  EXPECT_GT(what.held_back, 0);
}

}  // namespace
}  // namespace blem_sim::geometry
