#include <gtest/gtest.h>

#include <cmath>

#include "blem_sim/geometry/triangle_mesh.h"
#include "blem_sim/geometry/types.h"
#include "geometry/random_shapes.h"

namespace blem_sim::geometry {
namespace {

/** Volume by the divergence theorem: positive when the mesh is wound outwards. */
double signedVolume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const Vector3i& e : mesh.elements) {
    volume += mesh.vertices[e[0]].dot(mesh.vertices[e[1]].cross(mesh.vertices[e[2]])) / 6;
  }
  return volume;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Vector3i& e : mesh.elements) {
    const Vector3& a = mesh.vertices[e[0]];
    sum += (mesh.vertices[e[1]] - a).cross(mesh.vertices[e[2]] - a).norm() / 2;
  }
  return sum;
}

/** Expects a closed mesh with nothing to clean. */
void expectClosed(const TriangleMesh& mesh, int triangles) {
  MeshReport report;
  cleanMesh(mesh, &report);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.triangles, triangles);
  EXPECT_EQ(report.vertices, static_cast<int>(mesh.vertices.size()));
  EXPECT_EQ(report.degenerate + report.duplicate + report.welded, 0);
}

TEST(Primitives, BoxIsClosedAndWoundOutwards) {
  const TriangleMesh box = boxMesh({1, 2, 3});
  expectClosed(box, 12);
  EXPECT_DOUBLE_EQ(signedVolume(box), 6);
  EXPECT_DOUBLE_EQ(area(box), 22);
  EXPECT_TRUE(box.bounds().isApprox(Box(Vector3(-0.5, -1, -1.5), Vector3(0.5, 1, 1.5))));
  // No edge with one vertex on the diagonals of other faces: each triangle lies in one face.
  for (const Vector3i& e : box.elements) {
    const Vector3 sum = (box.vertices[e[0]] + box.vertices[e[1]] + box.vertices[e[2]]).cwiseQuotient(Vector3(0.5, 1, 1.5));
    EXPECT_EQ(sum.cwiseAbs().maxCoeff(), 3);
  }
}

TEST(Primitives, CylinderIsClosedAndWoundOutwards) {
  const TriangleMesh cylinder = cylinderMesh(0.5, 2, 64);
  expectClosed(cylinder, 256);
  EXPECT_NEAR(signedVolume(cylinder), 64 * 0.5 * 0.25 * std::sin(2 * M_PI / 64) * 2, 1e-13);
  for (const Vector3& v : cylinder.vertices) {
    EXPECT_EQ(std::abs(v.z()), 1);
    const double radius = v.head<2>().norm();
    EXPECT_TRUE(radius == 0 || std::abs(radius - 0.5) < 1e-15);
  }
}

TEST(Primitives, GridFacesUp) {
  const TriangleMesh grid = gridMesh(3, 2, 6, 5);
  EXPECT_EQ(grid.elements.size(), 60u);
  EXPECT_EQ(grid.vertices.size(), 42u);
  EXPECT_NEAR(area(grid), 6, 1e-14);
  EXPECT_TRUE(grid.bounds().isApprox(Box(Vector3(-1.5, -1, 0), Vector3(1.5, 1, 0))));
  for (const Vector3i& e : grid.elements) {
    EXPECT_GT((grid.vertices[e[1]] - grid.vertices[e[0]]).cross(grid.vertices[e[2]] - grid.vertices[e[0]]).z(), 0);
  }
}

TEST(Primitives, IcosphereLiesOnTheSphere) {
  for (int level = 0; level < 4; ++level) {
    const TriangleMesh sphere = icosphereMesh(0.3, level);
    expectClosed(sphere, 20 << (2 * level));
    for (const Vector3& v : sphere.vertices) EXPECT_NEAR(v.norm(), 0.3, 1e-15);
    EXPECT_GT(signedVolume(sphere), 0);
  }
  EXPECT_NEAR(signedVolume(icosphereMesh(0.3, 5)), 4.0 / 3 * M_PI * 0.027, 1e-3 * 0.113);
}

TEST(Primitives, PointAndSegmentAreElementsOfTheirOwn) {
  const TriangleMesh point = pointMesh({1, 2, 3}), segment = segmentMesh({1, 2, 3}, {4, 5, 6});
  EXPECT_TRUE(point.isPoint(0));
  EXPECT_FALSE(point.isTriangle(0));
  EXPECT_FALSE(segment.isPoint(0));
  EXPECT_FALSE(segment.isTriangle(0));
  EXPECT_EQ(segment.bounds().min(), Vector3(1, 2, 3));
  EXPECT_EQ(segment.bounds().max(), Vector3(4, 5, 6));
  EXPECT_TRUE(boxMesh({1, 1, 1}).isTriangle(0));
}

TEST(Transformed, ScalesThenMoves) {
  const TriangleMesh moved = transformed(pointMesh({1, 2, 3}), makePose({10, 0, 0}, {0, 0, M_PI / 2}), {1, 2, 3});
  EXPECT_TRUE(moved.vertices[0].isApprox(Vector3(10 - 4, 1, 9), 1e-14));
}

TEST(Transformed, MirroredIsStillWoundOutwards) {
  EXPECT_DOUBLE_EQ(signedVolume(transformed(boxMesh({1, 1, 1}), makePose({5, 0, 0}), {-2, 1, 1})), 2);
  EXPECT_DOUBLE_EQ(signedVolume(transformed(boxMesh({1, 1, 1}), makePose({5, 0, 0}), {-2, -1, 1})), 2);
}

TEST(Subdivided, IsTheSameSurfaceInSmallerTriangles) {
  const TriangleMesh box = boxMesh({1, 2, 3}), fine = subdivided(box, 3);
  expectClosed(fine, 12 * 64);
  EXPECT_NEAR(area(fine), area(box), 1e-13);
  EXPECT_NEAR(signedVolume(fine), 6, 1e-13);
  EXPECT_EQ(subdivided(box, 0).elements, box.elements);
}

TEST(Subdivided, HalvesSegmentsAndKeepsPoints) {
  const TriangleMesh segment = subdivided(segmentMesh({0, 0, 0}, {4, 0, 0}), 2);
  EXPECT_EQ(segment.elements.size(), 4u);
  EXPECT_EQ(segment.vertices.size(), 5u);
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(segment.isPoint(i) || segment.isTriangle(i));
  EXPECT_EQ(subdivided(pointMesh({1, 2, 3}), 3).elements.size(), 1u);
}

TEST(MakePose, IsTheFixedAxisConvention) {
  const Pose X_AB = makePose({1, 2, 3}, {M_PI / 2, 0, M_PI / 2});
  // Roll carries y to z, then yaw carries x to y.
  EXPECT_TRUE((X_AB.linear() * Vector3::UnitY()).isApprox(Vector3::UnitZ()));
  EXPECT_TRUE((X_AB.linear() * Vector3::UnitX()).isApprox(Vector3::UnitY()));
  EXPECT_EQ(X_AB.translation(), Vector3(1, 2, 3));
}

}  // namespace
}  // namespace blem_sim::geometry
