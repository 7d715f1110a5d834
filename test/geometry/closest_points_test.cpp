#include "blem_sim/geometry/closest_points.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "geometry/random_shapes.h"
#include "geometry/simplex_oracle.h"
#include "support/sanitizers.h"

namespace blem_sim::geometry {
namespace {

/** The distance is the oracle's, the points are as far apart as said, and each lies in its triangle. */
void expectExact(const Triangle& a, const Triangle& b, double tolerance, const std::string& what) {
  const ClosestPoints found = closestTriangleTriangle(a, b);
  ASSERT_NEAR(found.distance, oracleDistance(a, b), tolerance) << what;
  ASSERT_NEAR((found.point_a - found.point_b).norm(), found.distance, tolerance) << what;
  ASSERT_NEAR(oracleDistance(found.point_a, a), 0, tolerance) << what;
  ASSERT_NEAR(oracleDistance(found.point_b, b), 0, tolerance) << what;
  ASSERT_NEAR(closestTriangleTriangle(b, a).distance, found.distance, tolerance) << what;
}

/** A pair of triangles from a family of cases. */
using MakePair = std::function<std::pair<Triangle, Triangle>(RandomShapes&)>;

struct Family {
  std::string name;
  int count;
  double tolerance;  // [m]
  MakePair make;
};

Triangle collinear(RandomShapes& random) {
  const Vector3 p = random.point(1), d = random.point(1);
  return {p, p + random.uniform(-1, 1) * d, p + random.uniform(-1, 1) * d};
}

Triangle needle(RandomShapes& random, double height) {
  const Vector3 p = random.point(1), q = random.point(1);
  return {p, q, p + random.uniform(0, 1) * (q - p) + height * random.point(1)};
}

/** Two triangles in one plane or in parallel ones, each with a side along x: the case that PQP gets wrong. */
std::pair<Triangle, Triangle> withParallelSides(RandomShapes& random) {
  const auto planar = [&random](double z) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), length = random.uniform(-1, 1);
    const Vector3 apex(random.uniform(-1, 1), random.uniform(-1, 1), z);
    return Triangle{Vector3(x, y, z), Vector3(x + length, y, z), apex};
  };
  const Triangle a = planar(0);
  return {a, planar(random.integer(0, 1) * random.uniform(-0.3, 0.3))};
}

const std::vector<Family>& families() {
  static const std::vector<Family> FAMILIES = {
      {"far and near", 20000, 1e-14,
       [](RandomShapes& r) {
         const Triangle a = r.triangle(1);
         return std::make_pair(a, moved(r.triangle(1), r.point(2)));
       }},
      {"parallel sides in parallel planes", 20000, 1e-14, withParallelSides},
      {"parallel sides, turned", 20000, 1e-13,
       [](RandomShapes& r) {
         const auto pair = withParallelSides(r);
         const Pose X = r.pose(1);
         return std::make_pair(X * pair.first, X * pair.second);
       }},
      {"nearly parallel sides", 20000, 1e-13,
       [](RandomShapes& r) {
         auto pair = withParallelSides(r);
         const double tilt = std::pow(10, r.uniform(-17, -3));
         for (Vector3& corner : pair.second) corner += tilt * r.point(1);
         return pair;
       }},
      {"corners of a grid", 20000, 1e-14, [](RandomShapes& r) { return std::make_pair(r.gridTriangle(2), r.gridTriangle(2)); }},
      {"corners of a grid, turned", 8000, 1e-13,
       [](RandomShapes& r) {
         const Pose X = r.pose(1);
         return std::make_pair(X * r.gridTriangle(2), X * r.gridTriangle(2));
       }},
      {"collinear and a triangle", 4000, 1e-13, [](RandomShapes& r) { return std::make_pair(collinear(r), r.triangle(1)); }},
      {"both collinear", 4000, 1e-13, [](RandomShapes& r) { return std::make_pair(collinear(r), collinear(r)); }},
      {"a segment and a point", 4000, 1e-14,
       [](RandomShapes& r) {
         const Vector3 p = r.point(1), q = r.point(1), s = r.point(1);
         return std::make_pair(Triangle{p, q, q}, Triangle{s, s, s});
       }},
      {"needles of 1 um", 4000, 1e-13, [](RandomShapes& r) { return std::make_pair(needle(r, 1e-6), r.triangle(1)); }},
      {"needles of any height", 4000, 2e-10,
       [](RandomShapes& r) { return std::make_pair(needle(r, std::pow(10, r.uniform(-17, -3))), needle(r, 1e-9)); }},
      {"touching at a corner", 4000, 1e-14,
       [](RandomShapes& r) {
         const Triangle a = r.triangle(1);
         Triangle b = r.triangle(1);
         b[r.integer(0, 2)] = a[r.integer(0, 2)];
         return std::make_pair(a, b);
       }},
      {"sharing a side", 4000, 1e-14,
       [](RandomShapes& r) {
         const Triangle a = r.triangle(1);
         return std::make_pair(a, Triangle{a[1], a[0], r.point(1)});
       }},
      {"the same triangle", 1000, 1e-14,
       [](RandomShapes& r) {
         const Triangle a = r.triangle(1);
         return std::make_pair(a, Triangle{a[2], a[1], a[0]});
       }},
      {"far from the origin", 4000, 1e-11,
       [](RandomShapes& r) {
         return std::make_pair(moved(r.triangle(1), {1000, -500, 200}), moved(r.triangle(1), {1000, -500, 200}));
       }},
      {"large and small", 4000, 1e-10, [](RandomShapes& r) { return std::make_pair(r.triangle(1e4), r.triangle(1e-6)); }}};
  return FAMILIES;
}

TEST(ClosestTriangleTriangle, IsTheEnumerationOfFacesInEveryFamily) {
  for (const Family& family : families()) {
    RandomShapes random(7);
    for (int i = 0; i < samples(family.count); ++i) {
      const auto [a, b] = family.make(random);
      expectExact(a, b, family.tolerance, family.name + ", pair " + std::to_string(i));
      if (HasFatalFailure()) return;
    }
  }
}

TEST(ClosestTriangleTriangle, NoSampleIsCloser) {
  RandomShapes random(3);
  constexpr int N = 12;
  for (int i = 0; i < 1000; ++i) {
    const auto [a, b] = withParallelSides(random);
    const double distance = closestTriangleTriangle(a, b).distance;
    for (int u = 0; u <= N; ++u) {
      for (int v = 0; u + v <= N; ++v) {
        const Vector3 sample = (u * a[0] + v * a[1] + (N - u - v) * a[2]) / N;
        ASSERT_LE(distance, closestPointTriangle(sample, b).distance + 1e-14) << "pair " << i;
      }
    }
  }
}

TEST(ClosestTriangleTriangle, IsTheSameInEveryFrame) {
  RandomShapes random(5);
  for (int i = 0; i < 5000; ++i) {
    const Triangle a = random.triangle(1), b = random.triangle(1);
    const Pose X = random.pose(1);
    ASSERT_NEAR(closestTriangleTriangle(a, b).distance, closestTriangleTriangle(X * a, X * b).distance, 1e-14) << "pair " << i;
  }
}

TEST(ClosestTriangleTriangle, IsExactlyZeroWhereTheyMeet) {
  RandomShapes random(11);
  for (int i = 0; i < 20000; ++i) {
    // Both triangles hold the point p, which is inside one and inside, on the border, or at a corner of the other.
    const Vector3 p = random.point(1);
    Triangle a = random.triangle(1);
    a[2] = 3 * p - a[0] - a[1];
    Triangle b = random.triangle(1);
    if (i % 3 == 0) b[2] = 3 * p - b[0] - b[1];
    if (i % 3 == 1) b[1] = 2 * p - b[0];
    if (i % 3 == 2) b[0] = p;
    const ClosestPoints found = closestTriangleTriangle(a, b);
    ASSERT_EQ(found.distance, 0) << "pair " << i;
    ASSERT_EQ(found.point_a, found.point_b) << "pair " << i;
  }
}

TEST(ClosestTriangleTriangle, OfPointsIsTheirDistance) {
  const Vector3 p(1, 2, 3), q(1, 2, 5);
  const ClosestPoints found = closestTriangleTriangle({p, p, p}, {q, q, q});
  EXPECT_EQ(found.distance, 2);
  EXPECT_EQ(found.point_a, p);
  EXPECT_EQ(found.point_b, q);
}

TEST(ClosestPointTriangle, IsTheEnumerationOfFaces) {
  RandomShapes random(13);
  for (int i = 0; i < 30000; ++i) {
    const Triangle t = i % 3 == 0 ? random.triangle(1) : i % 3 == 1 ? random.gridTriangle(2) : collinear(random);
    const Vector3 p = i % 2 == 0 ? random.point(2) : random.gridPoint(2);
    const ClosestPoints found = closestPointTriangle(p, t);
    ASSERT_NEAR(found.distance, oracleDistance(p, t), 1e-14) << "triangle " << i;
    ASSERT_EQ(found.point_a, p);
    ASSERT_NEAR((found.point_b - p).norm(), found.distance, 1e-14);
    ASSERT_NEAR(oracleDistance(found.point_b, t), 0, 1e-14);
  }
}

TEST(ClosestPointTriangle, KnowsItsRegions) {
  const Triangle t = {Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(0, 2, 0)};
  EXPECT_EQ(closestPointTriangle({0.5, 0.5, 3}, t).point_b, Vector3(0.5, 0.5, 0));
  EXPECT_EQ(closestPointTriangle({1, -4, 0}, t).point_b, Vector3(1, 0, 0));
  EXPECT_EQ(closestPointTriangle({2, 2, 0}, t).point_b, Vector3(1, 1, 0));
  EXPECT_EQ(closestPointTriangle({-1, -1, 0}, t).point_b, Vector3(0, 0, 0));
  EXPECT_EQ(closestPointTriangle({0.5, 0.5, -3}, t).distance, 3);
}

TEST(ClosestSegmentSegment, IsTheEnumerationOfFaces) {
  RandomShapes random(17);
  for (int i = 0; i < 50000; ++i) {
    Vector3 a0 = random.gridPoint(2), a1 = random.gridPoint(2), b0 = random.gridPoint(2), b1 = random.gridPoint(2);
    if (i % 2 == 0) {
      a0 = random.point(1), a1 = random.point(1), b0 = random.point(1), b1 = random.point(1);
    }
    // Segments parallel up to a tilt between nothing and a milliradian.
    if (i % 4 == 0) b1 = b0 + random.uniform(-2, 2) * (a1 - a0) + std::pow(10, random.uniform(-18, -3)) * random.point(1);
    const ClosestPoints found = closestSegmentSegment(a0, a1, b0, b1);
    ASSERT_NEAR(found.distance, simplexDistance({a0, a1}, {b0, b1}), 1e-14) << "pair " << i;
    ASSERT_NEAR((found.point_a - found.point_b).norm(), found.distance, 1e-14) << "pair " << i;
    ASSERT_NEAR(simplexDistance({found.point_a}, {a0, a1}), 0, 1e-14) << "pair " << i;
    ASSERT_NEAR(simplexDistance({found.point_b}, {b0, b1}), 0, 1e-14) << "pair " << i;
  }
}

TEST(ClosestSegmentSegment, ParallelSegmentsSideBySideAndInLine) {
  EXPECT_EQ(closestSegmentSegment({0, 0, 0}, {1, 0, 0}, {0.5, 2, 0}, {3, 2, 0}).distance, 2);
  EXPECT_EQ(closestSegmentSegment({0, 0, 0}, {1, 0, 0}, {4, 0, 0}, {3, 0, 0}).distance, 2);
  EXPECT_EQ(closestSegmentSegment({0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {3, 0, 0}).distance, 0);
  EXPECT_EQ(closestSegmentSegment({1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}).distance, 0);
}

TEST(SegmentCrossesTriangle, InsideBorderCornerAndPlane) {
  const Triangle t = {Vector3(0, 0, 0), Vector3(2, 0, 0), Vector3(0, 2, 0)};
  EXPECT_TRUE(segmentCrossesTriangle({0.5, 0.5, -1}, {0.5, 0.5, 1}, t));
  EXPECT_TRUE(segmentCrossesTriangle({1, 0, -1}, {1, 0, 1}, t)) << "through a side";
  EXPECT_TRUE(segmentCrossesTriangle({0, 2, -1}, {0, 2, 1}, t)) << "through a corner";
  EXPECT_TRUE(segmentCrossesTriangle({0.5, 0.5, 0}, {0.5, 0.5, 1}, t)) << "touching from above";
  EXPECT_TRUE(segmentCrossesTriangle({-1, 0.5, 0}, {1, 0.5, 0}, t)) << "in the plane";
  EXPECT_FALSE(segmentCrossesTriangle({0.5, 0.5, 0.001}, {0.5, 0.5, 1}, t)) << "ends above";
  EXPECT_FALSE(segmentCrossesTriangle({1.5, 1.5, -1}, {1.5, 1.5, 1}, t)) << "beside";
  EXPECT_FALSE(segmentCrossesTriangle({-1, 3, 0}, {3, 3, 0}, t)) << "in the plane, beside";
}

TEST(SegmentCrossesTriangle, NothingSlipsThroughASharedSide) {
  RandomShapes random(19);
  for (int i = 0; i < 20000; ++i) {
    const Vector3 p = random.point(1), q = random.point(1), r = random.point(1), s = random.point(1);
    const Vector3 on_side = p + random.uniform(0, 1) * (q - p), along = random.point(1);
    const bool left = segmentCrossesTriangle(on_side - along, on_side + along, {p, q, r});
    const bool right = segmentCrossesTriangle(on_side - along, on_side + along, {q, p, s});
    ASSERT_TRUE(left || right) << "side " << i;
  }
}

TEST(ClosestMeshMeshBruteForce, OfTwoBoxes) {
  const TriangleMesh box = boxMesh({1, 1, 1});
  EXPECT_NEAR(closestMeshMeshBruteForce(box, box, makePose({1.25, 0.2, 0})).distance, 0.25, 1e-15);
  EXPECT_EQ(closestMeshMeshBruteForce(box, box, makePose({0.9, 0.2, 0.1})).distance, 0);
  // A corner over a face.
  const ClosestPoints found = closestMeshMeshBruteForce(pointMesh({0, 0, 0}), box, makePose({0.1, 0.2, 2}));
  EXPECT_NEAR(found.distance, 1.5, 1e-15);
  EXPECT_TRUE(found.point_a.isApprox(Vector3(0.1, 0.2, 2)));
  EXPECT_TRUE(found.point_b.isApprox(Vector3(0.1, 0.2, 0.5)));
}

}  // namespace
}  // namespace blem_sim::geometry
