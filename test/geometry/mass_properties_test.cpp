#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "blem_sim/geometry/mesh_winding.h"
#include "blem_sim/geometry/triangle_mesh.h"
#include "geometry/random_shapes.h"

namespace blem_sim::geometry {
namespace {

Matrix3 diagonal(double x, double y, double z) { return Vector3(x, y, z).asDiagonal(); }

TEST(MassFromVolume, OfABox) {
  MassProperties found;
  ASSERT_TRUE(massFromVolume(boxMesh({1, 2, 3}), 6, &found));
  EXPECT_EQ(found.mass, 6);
  EXPECT_LT(found.com.norm(), 1e-15);
  EXPECT_TRUE(found.inertia.isApprox(diagonal(4 + 9, 1 + 9, 1 + 4) * 6 / 12, 1e-14)) << found.inertia;
}

TEST(MassFromVolume, OfATetrahedron) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.elements = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  MassProperties found;
  ASSERT_TRUE(massFromVolume(mesh, 1, &found));
  EXPECT_TRUE(found.com.isApprox(Vector3::Constant(0.25), 1e-14));
  // Integrals over the unit simplex: E[x x] = 1/10, E[x y] = 1/20.
  EXPECT_NEAR(found.inertia(0, 0), 2 * (0.1 - 1.0 / 16), 1e-15);
  EXPECT_NEAR(found.inertia(0, 1), -(0.05 - 1.0 / 16), 1e-15);
}

TEST(MassFromVolume, EitherWindingAndAnyFrame) {
  const TriangleMesh box = boxMesh({0.1, 0.2, 0.3});
  RandomShapes random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose X = random.pose(10);
    TriangleMesh moved = transformed(box, X);
    if (i % 2 == 0) {
      for (Vector3i& e : moved.elements) e = Vector3i(e.reverse());
    }
    MassProperties found;
    ASSERT_TRUE(massFromVolume(moved, 2, &found));
    EXPECT_LT((found.com - X.translation()).norm(), 1e-12);
    const Matrix3 expected = X.linear() * diagonal(0.13, 0.10, 0.05) * X.linear().transpose() * 2 / 12;
    EXPECT_TRUE(found.inertia.isApprox(expected, 1e-9)) << found.inertia;
  }
}

TEST(MassFromVolume, ApproachesTheSphere) {
  MassProperties found;
  ASSERT_TRUE(massFromVolume(icosphereMesh(0.5, 5), 3, &found));
  EXPECT_TRUE(found.inertia.isApprox(0.4 * 3 * 0.25 * Matrix3::Identity(), 2e-3));
}

TEST(MassFromVolume, OfAHollowBoxLeavesTheHoleOut) {
  TriangleMesh mesh = boxMesh({2, 2, 2});
  const TriangleMesh hole = boxMesh({1, 1, 1});
  mesh.vertices.insert(mesh.vertices.end(), hole.vertices.begin(), hole.vertices.end());
  for (const Vector3i& e : hole.elements) mesh.elements.push_back(Vector3i(e.reverse()) + Vector3i::Constant(8));
  MassProperties found;
  ASSERT_TRUE(massFromVolume(mesh, 7, &found));
  EXPECT_NEAR(found.inertia(0, 0), (8.0 * 8 - 1.0 * 2) / 12, 1e-13);
}

TEST(MassFromVolume, RefusesWhatEnclosesNothing) {
  MassProperties untouched;
  untouched.mass = -7;
  TriangleMesh open = boxMesh({1, 1, 1});
  open.elements.pop_back();
  EXPECT_FALSE(massFromVolume(open, 1, &untouched));
  TriangleMesh half_flipped = boxMesh({1, 1, 1});
  for (int i = 0; i < 6; ++i) half_flipped.elements[i] = Vector3i(half_flipped.elements[i].reverse());
  EXPECT_FALSE(massFromVolume(half_flipped, 1, &untouched));
  TriangleMesh flat = transformed(boxMesh({1, 1, 1}), Pose::Identity(), {1, 1, 0});
  EXPECT_FALSE(massFromVolume(flat, 1, &untouched));
  EXPECT_FALSE(massFromVolume(gridMesh(1, 1, 2, 2), 1, &untouched));
  EXPECT_FALSE(massFromVolume(pointMesh({1, 1, 1}), 1, &untouched));
  EXPECT_FALSE(massFromVolume(TriangleMesh(), 1, &untouched));
  EXPECT_EQ(untouched.mass, -7);
}

void append(const TriangleMesh& part, const Vector3& at, TriangleMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  for (const Vector3& v : part.vertices) mesh->vertices.push_back(v + at);
  for (const Vector3i& e : part.elements) mesh->elements.push_back(e + Vector3i::Constant(first));
}

TriangleMesh insideOut(TriangleMesh mesh) {
  for (Vector3i& e : mesh.elements) e = Vector3i(e.reverse());
  return mesh;
}

/** A hollow box with a ball in its hole, and a smaller box beside it; each may be inside out, all on its own or a few triangles of it. */
TriangleMesh mixedParts(bool box_turned, bool beside_turned, int flipped) {
  TriangleMesh hollow = boxMesh({2, 2, 2});
  append(insideOut(boxMesh({1, 1, 1})), Vector3::Zero(), &hollow);
  append(icosphereMesh(0.2, 2), Vector3::Zero(), &hollow);
  TriangleMesh all = box_turned ? insideOut(hollow) : hollow;
  append(beside_turned ? insideOut(boxMesh({1, 1, 2})) : boxMesh({1, 1, 2}), {3, 0, 0}, &all);
  for (int i = 0; i < flipped; ++i) all.elements[5 * i] = Vector3i(all.elements[5 * i].reverse());
  return all;
}

// Parts that were inside out counted as holes, and one flipped triangle made a shell of all.
TEST(MassFromVolume, OfPartsWhateverTheirWinding) {
  MassProperties expected;
  ASSERT_TRUE(massFromVolume(mixedParts(false, false, 0), 3, &expected));
  for (const bool box_turned : {false, true})
    for (const bool beside_turned : {false, true})
      for (const int flipped : {0, 1, 4}) {
        MassProperties found;
        ASSERT_TRUE(massFromVolume(woundOutward(mixedParts(box_turned, beside_turned, flipped)), 3, &found));
        EXPECT_LT((found.com - expected.com).norm(), 1e-13) << box_turned << beside_turned << flipped;
        EXPECT_LT((found.inertia - expected.inertia).norm(), 1e-12) << box_turned << beside_turned << flipped;
      }
}

TEST(WoundOutward, LeavesWhatIsOpenOrOneSidedAsItIs) {
  TriangleMesh open = boxMesh({1, 1, 1});
  open.elements.pop_back();
  open.elements[3] = Vector3i(open.elements[3].reverse());
  EXPECT_EQ(woundOutward(open).elements, open.elements);
  const TriangleMesh box = boxMesh({1, 2, 3});
  EXPECT_EQ(woundOutward(box).elements, box.elements);
  // The projective plane on six vertices: closed, with one side.
  TriangleMesh plane;
  plane.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}};
  plane.elements = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1}, {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}};
  EXPECT_EQ(woundOutward(plane).elements, plane.elements);
}

TEST(MassFromSurface, OfASquarePlateAndOfATriangle) {
  const MassProperties plate = massFromSurface(transformed(gridMesh(2, 1, 3, 5), makePose({1, 2, 3})), 12);
  EXPECT_TRUE(plate.com.isApprox(Vector3(1, 2, 3), 1e-14));
  EXPECT_TRUE(plate.inertia.isApprox(diagonal(1, 4, 5), 1e-13)) << plate.inertia;

  TriangleMesh triangle;
  triangle.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.elements = {{0, 1, 2}};
  const MassProperties found = massFromSurface(triangle, 1);
  EXPECT_TRUE(found.com.isApprox(Vector3(1, 1, 0) / 3, 1e-14));
  EXPECT_NEAR(found.inertia(0, 0), 1.0 / 18, 1e-15);
  EXPECT_NEAR(found.inertia(0, 1), 1.0 / 36, 1e-15);
  // Even one flat triangle can turn about every axis.
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix3>(found.inertia).eigenvalues().minCoeff(), 0.01);
}

TEST(MassFromSurface, OfAHollowBoxIsHeavierToTurnThanASolidOne) {
  MassProperties solid;
  ASSERT_TRUE(massFromVolume(boxMesh({1, 1, 1}), 1, &solid));
  const MassProperties shell = massFromSurface(boxMesh({1, 1, 1}), 1);
  EXPECT_NEAR(shell.inertia(0, 0), 5.0 / 18, 1e-14);
  EXPECT_NEAR(solid.inertia(0, 0), 3.0 / 18, 1e-14);
}

TEST(MassFromSurface, OfSegmentsAndPoints) {
  for (const Vector3i& spelling : {Vector3i(0, 1, 1), Vector3i(0, 0, 1), Vector3i(0, 1, 0)}) {
    TriangleMesh rod = segmentMesh({0, 0, 1}, {0, 0, 4});
    rod.elements = {spelling};
    const MassProperties found = massFromSurface(rod, 4);
    EXPECT_TRUE(found.com.isApprox(Vector3(0, 0, 2.5), 1e-14));
    EXPECT_LT((found.inertia - diagonal(3, 3, 0)).norm(), 1e-14);
  }

  const MassProperties dumbbell = massFromSurface(pointCloudMesh({{1, 0, 0}, {3, 0, 0}}, nullptr), 2);
  EXPECT_TRUE(dumbbell.com.isApprox(Vector3(2, 0, 0), 1e-14));
  EXPECT_LT((dumbbell.inertia - diagonal(0, 2, 2)).norm(), 1e-14);

  const MassProperties point = massFromSurface(pointMesh({1, 2, 3}), 5);
  EXPECT_EQ(point.com, Vector3(1, 2, 3));
  EXPECT_EQ(point.inertia, Matrix3::Zero());

  EXPECT_EQ(massFromSurface(TriangleMesh(), 5).mass, 5);
}

TEST(MassFromSurface, DoesNotDependOnTheTessellation) {
  const TriangleMesh coarse = boxMesh({1, 2, 3}), fine = subdivided(coarse, 2);
  const MassProperties one = massFromSurface(coarse, 2), other = massFromSurface(fine, 2);
  EXPECT_TRUE(one.inertia.isApprox(other.inertia, 1e-13));
  EXPECT_LT((one.com - other.com).norm(), 1e-14);
}

}  // namespace
}  // namespace blem_sim::geometry
