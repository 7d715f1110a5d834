// Rays against brute force over all elements, and against closed forms.
#include "blem_sim/geometry/ray_cast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/random_shapes.h"

namespace blem_sim::geometry {
namespace {

TriangleMesh randomTriangles(RandomShapes& random, int count) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Triangle t = moved(random.triangle(0.3), random.point(1));
    for (const Vector3& corner : t) mesh.vertices.push_back(corner);
    mesh.elements.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return mesh;
}

/** Place on a triangle's plane by solving o + t d = a + u (b - a) + v (c - a); infinity outside the triangle. */
double solvedHit(const Ray& ray, const Triangle& t) {
  Matrix3 system;
  system << t[1] - t[0], t[2] - t[0], -ray.direction;
  const Vector3 x = system.inverse() * (ray.origin - t[0]);
  return x[0] >= 0 && x[1] >= 0 && x[0] + x[1] <= 1 ? x[2] : INFINITY;
}

double byBruteForce(const TriangleMesh& mesh, const Ray& ray, const RayRange& range) {
  double best = INFINITY;
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    const double t = solvedHit(ray, triangleOf(mesh, static_cast<int>(i)));
    if (t >= range.nearest && t <= range.farthest) best = std::min(best, t);
  }
  return best;
}

TEST(CastRay, IsTheFirstHitOfAllTriangles) {
  RandomShapes random(9);
  const TriangleMesh mesh = randomTriangles(random, 500);
  const Bvh tree(mesh);
  int hits = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Ray ray{random.point(2), random.point(1).normalized()};
    const RayRange range = trial % 3 ? RayRange{} : RayRange{random.uniform(0, 1), random.uniform(1, 3)};
    const double expected = byBruteForce(mesh, ray, range);
    const RayHit hit = castRay({tree, mesh}, ray, range);
    ASSERT_EQ(hit.element >= 0, std::isfinite(expected)) << "ray " << trial;
    if (hit.element < 0) continue;
    ++hits;
    const Triangle t = triangleOf(mesh, hit.element);
    const double across = std::abs((t[1] - t[0]).cross(t[2] - t[0]).normalized().dot(ray.direction));
    ASSERT_NEAR(hit.t, expected, 1e-14 / across) << "ray " << trial << ": rounding, more of it where the ray grazes";
    ASSERT_NEAR(closestPointTriangle(ray.origin + hit.t * ray.direction, t).distance, 0, 1e-12);
  }
  EXPECT_GT(hits, 300);
}

TEST(CastRay, SlipsThroughNoSideOfAClosedSurface) {
  // Rays from the middle through vertices, sides and along the axes meet two triangles or more at their borders.
  for (const TriangleMesh& mesh : {icosphereMesh(1, 3), boxMesh({1, 2, 3}), subdivided(boxMesh({1, 1, 1}), 3)}) {
    const Bvh tree(mesh);
    for (const Vector3i& e : mesh.elements) {
      for (int k = 0; k < 3; ++k) {
        const Vector3 &p = mesh.vertices[e[k]], &q = mesh.vertices[e[(k + 1) % 3]];
        for (const double s : {0.0, 0.25, 0.5, 1.0 / 3}) ASSERT_NEAR(castRay({tree, mesh}, {Vector3::Zero(), p + s * (q - p)}).t, 1, 1e-12);
      }
    }
    for (int axis = 0; axis < 3; ++axis)
      for (const int sign : {-1, 1}) EXPECT_GE(castRay({tree, mesh}, {Vector3::Zero(), sign * Vector3::Unit(axis)}).element, 0);
  }
}

TEST(CastRay, LooksForwardOnlyAndSeesBothSides) {
  const TriangleMesh floor = gridMesh(2, 2, 1, 1);
  const Bvh tree(floor);
  const RayMesh target{tree, floor};
  EXPECT_NEAR(castRay(target, {{0.3, 0.1, 2}, {0, 0, -0.5}}).t, 4, 1e-15);
  EXPECT_GE(castRay(target, {{0.3, 0.1, -2}, {0, 0, 1}}).element, 0) << "from below";
  EXPECT_EQ(castRay(target, {{0.3, 0.1, 2}, {0, 0, 1}}).element, -1) << "away";
  EXPECT_EQ(castRay(target, {{1.5, 0.1, 2}, {0, 0, -1}}).element, -1) << "beside";
  EXPECT_EQ(castRay(target, {{0.3, 0.1, 2}, {0, 0, 0}}).element, -1) << "no direction";
  EXPECT_EQ(castRay(target, {{0.3, 0.1, 2}, {0, 0, -1}}, {0, 1.999}).element, -1) << "beyond the range";
  EXPECT_EQ(castRay(target, {{0.3, 0.1, 2}, {0, 0, -1}}, {2.001, 9}).element, -1) << "before the range";
  const TriangleMesh nothing;
  EXPECT_EQ(castRay({Bvh(nothing), nothing}, {{0, 0, 0}, {1, 0, 0}}).element, -1);
}

TEST(CastRay, RangeBeginsBehindTheNearestWall) {
  const TriangleMesh box = boxMesh({2, 2, 2});
  const Bvh tree(box);
  EXPECT_NEAR(castRay({tree, box}, {{-3, 0.1, 0.2}, {1, 0, 0}}).t, 2, 1e-15);
  EXPECT_NEAR(castRay({tree, box}, {{-3, 0.1, 0.2}, {1, 0, 0}}, {2.5, 10}).t, 4, 1e-15);
}

TEST(CastRay, PointsAreBalls) {
  RandomShapes random(3);
  TriangleMesh cloud;
  for (int i = 0; i < 400; ++i) {
    cloud.vertices.push_back(random.point(1));
    cloud.elements.emplace_back(i, i, i);
  }
  const Bvh tree(cloud);
  const double radius = 0.05;
  int hits = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector3 origin = random.point(2);
    const Ray ray{origin, (random.point(1) - origin).normalized()};
    double expected = INFINITY;
    for (const Vector3& centre : cloud.vertices) expected = std::min(expected, hitBall(ray, {}, centre, radius));
    const RayHit hit = castRay({tree, cloud, radius}, ray);
    ASSERT_EQ(hit.t, expected);
    if (hit.element < 0) continue;
    ++hits;
    ASSERT_NEAR((ray.origin + hit.t * ray.direction - cloud.vertices[hit.element]).norm(), radius, 1e-12);
  }
  EXPECT_GT(hits, 300);
  EXPECT_EQ(castRay({tree, cloud}, {cloud.vertices[0] + Vector3(0, 0, 3), {0, 0, -1}}).element, -1) << "points without a radius";
}

TEST(HitBall, FromOutsideInsideAndBehind) {
  const Vector3 centre(0, 0, 0);
  EXPECT_NEAR(hitBall({{-3, 0, 0}, {1, 0, 0}}, {}, centre, 1), 2, 1e-15);
  EXPECT_NEAR(hitBall({{-3, 0.6, 0}, {2, 0, 0}}, {}, centre, 1), 1.1, 1e-15);
  EXPECT_NEAR(hitBall({{0.5, 0, 0}, {1, 0, 0}}, {}, centre, 1), 0.5, 1e-15);
  EXPECT_NEAR(hitBall({{-3, 0, 0}, {1, 0, 0}}, {2.5, 10}, centre, 1), 4, 1e-15);
  EXPECT_EQ(hitBall({{3, 0, 0}, {1, 0, 0}}, {}, centre, 1), INFINITY);
  EXPECT_EQ(hitBall({{-3, 1.001, 0}, {1, 0, 0}}, {}, centre, 1), INFINITY);
  EXPECT_EQ(hitBall({{-3, 0, 0}, {1, 0, 0}}, {0, 1.9}, centre, 1), INFINITY);
  // A ball of a millimetre, 10 km away.
  EXPECT_NEAR(hitBall({{-1e4, 0, 0}, {1, 0, 0}}, {}, centre, 1e-3), 1e4 - 1e-3, 1e-11);
}

TEST(HitCapsule, TubeEndsAndAxis) {
  const std::array<Vector3, 2> axis = {Vector3(0, 0, 0), Vector3(0, 0, 2)};
  EXPECT_NEAR(hitCapsule({{-3, 0, 1}, {1, 0, 0}}, {}, axis, 0.5), 2.5, 1e-15) << "tube";
  EXPECT_NEAR(hitCapsule({{0, 0, 5}, {0, 0, -1}}, {}, axis, 0.5), 2.5, 1e-15) << "along the axis";
  EXPECT_NEAR(hitCapsule({{0.3, 0, 5}, {0, 0, -1}}, {}, axis, 0.5), 3 - 0.4, 1e-15) << "along the axis, beside it";
  EXPECT_NEAR(hitCapsule({{-3, 0, 2.3}, {1, 0, 0}}, {}, axis, 0.5), 2.6, 1e-15) << "round end";
  EXPECT_NEAR(hitCapsule({{0, 0, 1}, {1, 0, 0}}, {}, axis, 0.5), 0.5, 1e-15) << "from inside";
  EXPECT_EQ(hitCapsule({{-3, 0, 2.501}, {1, 0, 0}}, {}, axis, 0.5), INFINITY);
  EXPECT_EQ(hitCapsule({{0.501, 0, 5}, {0, 0, -1}}, {}, axis, 0.5), INFINITY);
}

TEST(HitCapsule, PlacesAreAtTheRadiusFromTheSegment) {
  RandomShapes random(5);
  int hits = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const std::array<Vector3, 2> axis = {random.point(1), random.point(1)};
    const Vector3 origin = random.point(3);
    const Ray ray{origin, (random.point(1) - origin).normalized()};
    const double radius = random.uniform(0.05, 0.6), t = hitCapsule(ray, {}, axis, radius);
    const auto distance = [&](double s) {
      return closestPointTriangle(ray.origin + s * ray.direction, {axis[0], axis[1], axis[1]}).distance;
    };
    for (double s = 0; s < std::min(t, 8.0); s += 0.01)
      ASSERT_EQ(distance(s) < radius - 1e-9, distance(0) < radius) << "no surface before the first, trial " << trial;
    if (t == INFINITY) continue;
    ++hits;
    ASSERT_NEAR(distance(t), radius, 1e-12) << trial;
  }
  EXPECT_GT(hits, 500);
}

TEST(CastRay, SegmentsAreCapsules) {
  const TriangleMesh segment = segmentMesh({0, 0, 0}, {0, 0, 2});
  const Bvh tree(segment);
  EXPECT_NEAR(castRay({tree, segment, 0.5}, {{-3, 0.3, 1}, {1, 0, 0}}).t, 3 - 0.4, 1e-15);
}

}  // namespace
}  // namespace blem_sim::geometry
