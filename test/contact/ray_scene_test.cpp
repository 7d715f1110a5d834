// Rays in a world of many colliders against asking each of them.
#include "blem_sim/contact/ray_scene.h"

#include <gtest/gtest.h>

#include "geometry/random_shapes.h"
#include "ray_turns.h"

namespace blem_sim::contact {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

std::shared_ptr<const CollisionGeometry> geometryOf(const geometry::TriangleMesh& mesh) {
  return std::make_shared<const CollisionGeometry>(std::make_shared<const geometry::TriangleMesh>(mesh));
}

RayTarget target(const geometry::TriangleMesh& mesh, const Pose& X_WC, double radius = 0, int model = 0) {
  return {geometryOf(mesh), X_WC, radius, model};
}

RayScene::Hit firstHit(const RayScene& scene, const geometry::Ray& ray, const RayScene::Query& query) {
  RayFan fan{ray.origin, {}};
  fan.directions.fill(ray.direction);
  return scene.firstHits(fan, query).back();
}

/** A triangle, a segment and a point, as far from each other as their neighbours of other kinds. */
geometry::TriangleMesh mixedMesh() {
  geometry::TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0.1}, {0.1, -0.2, 0.2}};
  mesh.elements = {{0, 1, 2}, {0, 3, 3}, {3, 3, 3}};
  return mesh;
}

/** First hit by asking every target on its own. */
RayScene::Hit firstByAsking(const std::vector<RayTarget>& targets, const geometry::Ray& ray, const RayScene::Query& query) {
  RayScene::Hit first;
  for (int i = 0; i < static_cast<int>(targets.size()); ++i) {
    const double nearest = targets[i].model == query.own_model ? query.own_nearest : 0;
    const Pose X_CW = targets[i].X_WC.inverse();
    const geometry::Ray ray_C{X_CW * ray.origin, turned(X_CW.linear(), ray.direction)};
    const CollisionGeometry& geometry = *targets[i].geometry;
    double t;
    if (geometry.isHalfSpace()) {
      const double fall = geometry.planeNormal().dot(ray_C.direction);
      t = (geometry.planeOffset() - geometry.planeNormal().dot(ray_C.origin)) / fall;
      if (!(t >= nearest && t <= query.farthest)) t = INFINITE;
    } else {
      t = geometry::castRay({geometry.bvh(), geometry.mesh(), targets[i].radius}, ray_C, {nearest, query.farthest}).t;
    }
    if (t < first.t) first = {t, i};
  }
  return first;
}

TEST(RayScene, IsTheFirstOfAllTargets) {
  geometry::RandomShapes random(21);
  std::vector<RayTarget> targets;
  for (int i = 0; i < 50; ++i) {
    const geometry::TriangleMesh shapes[] = {geometry::boxMesh({0.3, 0.2, 0.1}), geometry::icosphereMesh(0.2, 2),
                                             geometry::pointMesh({0.1, 0, 0}), geometry::segmentMesh({0, 0, 0}, {0.3, 0, 0}), mixedMesh()};
    targets.push_back(target(shapes[i % 5], random.pose(2), i % 2 ? 0.0025 : 0.1, i % 3));
  }
  targets.push_back({CollisionGeometry::halfSpace({0.1, 0, 1}, -1.5), makePose({0, 0, 0.2}), 0, 5});
  const RayScene scene(targets);
  int hits = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    // Rays close together, or in all directions.
    RayFan fan{random.point(3), {}};
    const Vector3 ahead = random.point(1);
    for (Vector3& direction : fan.directions) direction = trial % 4 ? Vector3(ahead + random.point(0.05)) : random.point(1);
    const RayScene::Query query{random.uniform(0, 6), trial % 3, random.uniform(0, 2)};
    const RayScene::Hits found = scene.firstHits(fan, query);
    for (int ray = 0; ray < RayFan::WIDTH; ++ray) {
      const RayScene::Hit expected = firstByAsking(targets, {fan.origin, fan.directions[ray]}, query);
      ASSERT_EQ(found[ray].t, expected.t) << "trial " << trial;
      ASSERT_EQ(found[ray].target, expected.target) << "trial " << trial;
      hits += expected.target >= 0;
    }
  }
  EXPECT_GT(hits, 3000);
}

TEST(RayScene, TurnedBoxSphereCapsuleAndHalfSpace) {
  const Pose X = makePose({2, 0, 0}, {0, 0, M_PI / 4});
  const geometry::Ray ahead{{0, 0, 0}, {1, 0, 0}};
  EXPECT_NEAR(firstHit(RayScene({target(geometry::boxMesh({1, 1, 1}), X)}), {{0, 0.1, 0}, {1, 0, 0}}, {}).t, 2 - std::sqrt(0.5) + 0.1,
              1e-15);
  EXPECT_NEAR(firstHit(RayScene({target(geometry::pointMesh({0.5, 0, 0}), makePose({2, 0, 0}), 0.25)}), ahead, {}).t, 2.25, 1e-15);
  EXPECT_NEAR(firstHit(RayScene({target(geometry::segmentMesh({0, 0, -1}, {0, 0, 1}), X, 0.25)}), ahead, {}).t, 1.75, 1e-15);
  const RayScene plane({{CollisionGeometry::halfSpace({0, 0, 1}, 0), makePose({0, 0, -1}), 0, 0}});
  EXPECT_NEAR(firstHit(plane, {{0, 0, 0}, {1, 0, -0.5}}, {}).t, 2, 1e-15);
  EXPECT_EQ(firstHit(plane, ahead, {}).t, INFINITE) << "along the plane";
  EXPECT_EQ(firstHit(plane, {{0, 0, 0}, {1, 0, 0.5}}, {}).target, -1);
  EXPECT_EQ(firstHit(RayScene({}), ahead, {}).target, -1);
}

TEST(RayScene, TrianglesAreBareAndTheOwnModelBeginsLater) {
  const std::vector<RayTarget> walls = {target(geometry::boxMesh({0.1, 2, 2}), makePose({1, 0, 0}), 0.01, 0),
                                        target(geometry::boxMesh({0.1, 2, 2}), makePose({3, 0, 0}), 0.01, 1)};
  const RayScene scene(walls);
  const geometry::Ray ahead{{0, 0.1, 0.2}, {1, 0, 0}};
  EXPECT_NEAR(firstHit(scene, ahead, {}).t, 0.95, 1e-15);
  EXPECT_NEAR(firstHit(scene, ahead, {10, 0, 1.5}).t, 2.95, 1e-15) << "through the own wall";
  EXPECT_NEAR(firstHit(scene, ahead, {10, 1, 1.5}).t, 0.95, 1e-15) << "the other's wall is not its own";
  EXPECT_NEAR(firstHit(scene, ahead, {10, 0, 1.0}).t, 1.05, 1e-15) << "out of the own wall";
  EXPECT_EQ(firstHit(scene, ahead, {0.9, -1, 0}).target, -1) << "beyond the range";
}

}  // namespace
}  // namespace blem_sim::contact
