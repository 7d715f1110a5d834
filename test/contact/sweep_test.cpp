#include "blem_sim/contact/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "blem_sim/geometry/closest_points.h"

namespace blem_sim::contact {
namespace {

CollisionGeometry sweptGeometry(const geometry::TriangleMesh& mesh) {
  return CollisionGeometry(std::make_shared<const geometry::TriangleMesh>(mesh));
}

GeometrySweep sweep(const Vector3& from, const Vector3& shift, const Vector3& turn = Vector3::Zero()) {
  return {makePose(from), from, shift, turn};
}

Vector3 randomVector(double size, std::mt19937_64* generator) {
  const auto uniform = [=] { return size * (2 * static_cast<double>((*generator)() >> 11) * 0x1p-53 - 1); };
  const double x = uniform(), y = uniform(), z = uniform();
  return {x, y, z};
}

std::array<geometry::TriangleMesh, 3> smallMeshes() {
  return {geometry::boxMesh({0.1, 0.05, 0.02}), geometry::gridMesh(0.2, 0.1, 1, 1), geometry::segmentMesh({0, 0, 0}, {0.1, 0, 0})};
}

TEST(Sweep, EndsWhereItsTurnAndShiftLead) {
  const Pose before = makePose({1, 2, 3}, {0.4, -0.3, 2}), after = makePose({1.5, 1, 3.25}, {-0.5, 0.2, 1.1});
  const Vector3 com(0.3, 0.1, -0.2);
  const GeometrySweep way{before, before * com, after * com - before * com, turnBetween(before, after)};
  EXPECT_TRUE(way.at(0).isApprox(before, 1e-14));
  EXPECT_TRUE(way.at(1).isApprox(after, 1e-14));
  EXPECT_TRUE((way.at(0.5) * com).isApprox(0.5 * (before * com + after * com), 1e-14));
}

TEST(Sweep, PlateThroughSheetIsSeenThoughNeitherEndIsNear) {
  const CollisionGeometry plate = sweptGeometry(geometry::gridMesh(0.1, 0.1, 1, 1)), sheet = sweptGeometry(geometry::gridMesh(4, 4, 1, 1));
  EXPECT_TRUE(mayComeWithin(1e-4, plate, sweep({0, 0, 0.05}, {0, 0, -0.1}), sheet, GeometrySweep{}));
  EXPECT_FALSE(mayComeWithin(1e-3, plate, sweep({0, 0, 0.05}, {0.3, 0, -0.048}), sheet, GeometrySweep{}));
  // Plate and sheet move on together.
  EXPECT_FALSE(mayComeWithin(0.04, plate, sweep({0, 0, 0.05}, {0, 0, -0.1}), sheet, sweep({0, 0, 0}, {0, 0, -0.1})));
  // The plate turns over: its edge comes down to the sheet half way.
  EXPECT_TRUE(mayComeWithin(1e-3, plate, sweep({0, 0, 0.0505}, Vector3::Zero(), {M_PI, 0, 0}), sheet, GeometrySweep{}));
  EXPECT_FALSE(mayComeWithin(1e-3, plate, sweep({0, 0, 0.0515}, Vector3::Zero(), {M_PI, 0, 0}), sheet, GeometrySweep{}));
}

TEST(Sweep, PointsPassEachOtherAtTheirDistance) {
  const CollisionGeometry point = sweptGeometry(geometry::pointMesh(Vector3::Zero()));
  EXPECT_TRUE(mayComeWithin(0.01, point, sweep({-1, 0, 0}, {2, 0, 0}), point, sweep({0, -1, 0.009}, {0, 2, 0})));
  EXPECT_FALSE(mayComeWithin(0.01, point, sweep({-1, 0, 0}, {2, 0, 0}), point, sweep({0, -1, 0.013}, {0, 2, 0})));
}

TEST(Sweep, OfWhatStandsStillIsItsDistance) {
  std::mt19937_64 generator(7);
  const auto vector = [&generator](double size) { return randomVector(size, &generator); };
  const std::array<geometry::TriangleMesh, 3> meshes = smallMeshes();
  int apart = 0;
  for (int i = 0; i < 300; ++i) {
    const geometry::TriangleMesh &a = meshes[i % 3], &b = meshes[i / 3 % 3];
    GeometrySweep at_a, at_b;
    at_a.X_WC = makePose(vector(0.1), vector(3));
    at_b.X_WC = makePose(vector(0.1), vector(3));
    const double distance = geometry::closestMeshMeshBruteForce(a, b, at_b.X_WC.inverse() * at_a.X_WC).distance;
    EXPECT_TRUE(mayComeWithin((1 + 1e-7) * distance + 1e-15, sweptGeometry(a), at_a, sweptGeometry(b), at_b)) << i;
    if (distance < 1e-6) continue;
    EXPECT_FALSE(mayComeWithin((1 - 1e-7) * distance, sweptGeometry(a), at_a, sweptGeometry(b), at_b)) << i;
    ++apart;
  }
  EXPECT_GT(apart, 150);
}

/** Sweeps against the distance at 300 poses on the way. */
TEST(Sweep, NeverMissesWhatSamplesFind) {
  std::mt19937_64 generator(3);
  const auto vector = [&generator](double size) { return randomVector(size, &generator); };
  const std::array<geometry::TriangleMesh, 3> meshes = smallMeshes();
  int seen = 0, cleared = 0;
  for (int i = 0; i < 150; ++i) {
    const geometry::TriangleMesh &a = meshes[i % 3], &b = meshes[i / 3 % 3];
    const GeometrySweep way_a{makePose(vector(0.1), vector(3)), vector(0.2), vector(0.3), vector(1.5)},
        way_b{makePose(vector(0.1), vector(3)), vector(0.2), vector(0.3), vector(1.5)};
    const double most = mostApproach(sweptGeometry(a), way_a, sweptGeometry(b), way_b);
    double least = INFINITY, start = 0;
    for (int k = 0; k <= 300; ++k) {
      const double d = geometry::closestMeshMeshBruteForce(a, b, way_b.at(k / 300.0).inverse() * way_a.at(k / 300.0)).distance;
      least = std::min(least, d);
      if (k == 0) start = d;
    }
    EXPECT_GE(most, start - least) << i;
    const double within = 0.01;
    const bool may = mayComeWithin(within, sweptGeometry(a), way_a, sweptGeometry(b), way_b);
    EXPECT_TRUE(may || least > within) << i;
    // Samples miss by the motion between two of them.
    EXPECT_TRUE(!may || least <= 1.25 * within + most / 300) << i;
    seen += may;
    cleared += !may;
  }
  EXPECT_GT(seen, 20);
  EXPECT_GT(cleared, 20);
}

}  // namespace
}  // namespace blem_sim::contact
