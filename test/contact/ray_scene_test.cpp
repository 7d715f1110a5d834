// Rays in a world of many colliders against asking each of them.
#include "blem_sim/contact/ray_scene.h"

#include <gtest/gtest.h>

#include "geometry/random_shapes.h"

namespace blem_sim::contact {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

std::shared_ptr<const CollisionGeometry> geometryOf(const geometry::TriangleMesh& mesh) {
  return std::make_shared<const CollisionGeometry>(std::make_shared<const geometry::TriangleMesh>(mesh));
}

RayTarget target(const geometry::TriangleMesh& mesh, const Pose& X_WC, double radius = 0, int model = 0) {
  return {geometryOf(mesh), X_WC, radius, model};
}

TEST(RayScene, IsTheFirstOfAllTargets) {
  geometry::RandomShapes random(21);
  std::vector<RayTarget> targets;
  for (int i = 0; i < 40; ++i) {
    const geometry::TriangleMesh shapes[] = {geometry::boxMesh({0.3, 0.2, 0.1}), geometry::icosphereMesh(0.2, 2),
                                             geometry::pointMesh({0.1, 0, 0}), geometry::segmentMesh({0, 0, 0}, {0.3, 0, 0})};
    targets.push_back(target(shapes[i % 4], random.pose(2), i % 2 ? 0.0025 : 0.1, i % 3));
  }
  targets.push_back({CollisionGeometry::halfSpace({0.1, 0, 1}, -1.5), makePose({0, 0, 0.2}), 0, 5});
  const RayScene scene(targets);
  int hits = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const geometry::Ray ray{random.point(3), random.point(1)};
    const RayScene::Query query{random.uniform(0, 6), trial % 3, random.uniform(0, 2)};
    RayScene::Hit expected;
    for (int i = 0; i < static_cast<int>(targets.size()); ++i) {
      const RayScene::Hit alone = RayScene({targets[i]}).firstHit(ray, query);
      if (alone.t < expected.t) expected = {alone.t, i};
    }
    const RayScene::Hit hit = scene.firstHit(ray, query);
    ASSERT_EQ(hit.t, expected.t);
    ASSERT_EQ(hit.target, expected.target);
    hits += hit.target >= 0;
  }
  EXPECT_GT(hits, 500);
}

TEST(RayScene, TurnedBoxSphereCapsuleAndHalfSpace) {
  const Pose X = makePose({2, 0, 0}, {0, 0, M_PI / 4});
  const geometry::Ray ahead{{0, 0, 0}, {1, 0, 0}};
  EXPECT_NEAR(RayScene({target(geometry::boxMesh({1, 1, 1}), X)}).firstHit({{0, 0.1, 0}, {1, 0, 0}}, {}).t, 2 - std::sqrt(0.5) + 0.1,
              1e-15);
  EXPECT_NEAR(RayScene({target(geometry::pointMesh({0.5, 0, 0}), makePose({2, 0, 0}), 0.25)}).firstHit(ahead, {}).t, 2.25, 1e-15);
  EXPECT_NEAR(RayScene({target(geometry::segmentMesh({0, 0, -1}, {0, 0, 1}), X, 0.25)}).firstHit(ahead, {}).t, 1.75, 1e-15);
  const RayScene plane({{CollisionGeometry::halfSpace({0, 0, 1}, 0), makePose({0, 0, -1}), 0, 0}});
  EXPECT_NEAR(plane.firstHit({{0, 0, 0}, {1, 0, -0.5}}, {}).t, 2, 1e-15);
  EXPECT_EQ(plane.firstHit(ahead, {}).t, INFINITE) << "along the plane";
  EXPECT_EQ(plane.firstHit({{0, 0, 0}, {1, 0, 0.5}}, {}).target, -1);
  EXPECT_EQ(RayScene({}).firstHit(ahead, {}).target, -1);
}

TEST(RayScene, TrianglesAreBareAndTheOwnModelBeginsLater) {
  const std::vector<RayTarget> walls = {target(geometry::boxMesh({0.1, 2, 2}), makePose({1, 0, 0}), 0.01, 0),
                                        target(geometry::boxMesh({0.1, 2, 2}), makePose({3, 0, 0}), 0.01, 1)};
  const RayScene scene(walls);
  const geometry::Ray ahead{{0, 0.1, 0.2}, {1, 0, 0}};
  EXPECT_NEAR(scene.firstHit(ahead, {}).t, 0.95, 1e-15);
  EXPECT_NEAR(scene.firstHit(ahead, {10, 0, 1.5}).t, 2.95, 1e-15) << "through the own wall";
  EXPECT_NEAR(scene.firstHit(ahead, {10, 1, 1.5}).t, 0.95, 1e-15) << "the other's wall is not its own";
  EXPECT_NEAR(scene.firstHit(ahead, {10, 0, 1.0}).t, 1.05, 1e-15) << "out of the own wall";
  EXPECT_EQ(scene.firstHit(ahead, {0.9, -1, 0}).target, -1) << "beyond the range";
}

}  // namespace
}  // namespace blem_sim::contact
