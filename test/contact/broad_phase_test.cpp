#include "blem_sim/contact/broad_phase.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/contact_shapes.h"

namespace blem_sim::contact {
namespace {

struct PlacedBoxes {
  std::vector<Collider> colliders;
  std::vector<ColliderMotion> motion;

  int add(Collider collider, const Pose& X_WC, int body, int model, double reach = 0) {
    collider.body = body;
    collider.model = model;
    colliders.push_back(collider);
    motion.push_back({X_WC, reach});
    return static_cast<int>(colliders.size()) - 1;
  }
  std::vector<std::pair<int, int>> pairs(const CollisionFilter& filter = {}, double base = 0.001, double max = 0.1) const {
    std::vector<std::pair<int, int>> out;
    BroadPhase search;
    for (const ColliderPair& p : search.find(colliders, motion, filter, base, max)) out.emplace_back(p.a, p.b);
    return out;
  }
};

using Pairs = std::vector<std::pair<int, int>>;

Collider box(double radius = 0) { return makeCollider(geometry::boxMesh(Vector3::Constant(0.1)), radius); }

TEST(BroadPhase, NothingThatNarrowPhaseFindsIsMissed) {
  geometry::RandomShapes random(51);
  const Collider shapes[] = {box(0.002), makeCollider(octahedronMesh(0.06), 0.004),
                             makeCollider(geometry::pointMesh(Vector3::Zero()), 0.05)};
  int touching = 0;
  for (int round = 0; round < 40; ++round) {
    PlacedBoxes scene;
    scene.add(makeHalfSpace({0.1, 0, 1}, -0.3), makePose({0, 0, 0.02}, {0.1, 0, 0}), -1, 0);
    for (int i = 0; i < 30; ++i) {
      scene.add(shapes[i % 3], makePose(random.point(0.4), random.point(3)), i % 7 == 0 ? -1 : i, i, random.uniform(0, 0.02));
    }
    const std::vector<ColliderPair> found = BroadPhase().find(scene.colliders, scene.motion, {}, 0.001, 0.015);
    std::size_t next = 0;
    for (int a = 0; a < static_cast<int>(scene.colliders.size()); ++a) {
      for (int b = a + 1; b < static_cast<int>(scene.colliders.size()); ++b) {
        const double margin = std::min(0.015, std::max(0.001, scene.motion[a].reach + scene.motion[b].reach));
        const bool listed = next < found.size() && found[next].a == a && found[next].b == b;
        if (listed) {
          EXPECT_DOUBLE_EQ(found[next++].margin, margin);
        }
        if (scene.colliders[a].body == scene.colliders[b].body) {
          EXPECT_FALSE(listed);
          continue;
        }
        const ContactManifold manifold =
            contactsOf(scene.colliders[a], scene.motion[a].X_WC, scene.colliders[b], scene.motion[b].X_WC, margin);
        if (manifold.contacts.empty()) continue;
        ++touching;
        EXPECT_TRUE(listed) << a << " " << b;
      }
    }
    EXPECT_EQ(next, found.size());  // sorted by (a, b), nothing twice
  }
  EXPECT_GT(touching, 400);
}

/** Every pair of boxes asked. */
Pairs everyPair(const PlacedBoxes& scene, double base, double max) {
  const auto reach = [&](int i) { return scene.colliders[i].radius + scene.motion[i].reach; };
  const auto boxOf = [&](int i) {
    Box box;
    for (int corner = 0; corner < 8; ++corner)
      box.extend(scene.motion[i].X_WC * scene.colliders[i].geometry->bounds().corner(static_cast<Box::CornerType>(corner)));
    return box;
  };
  std::vector<Box> boxes;
  for (int i = 0; i < static_cast<int>(scene.colliders.size()); ++i) boxes.push_back(boxOf(i));
  Pairs pairs;
  for (int a = 0; a < static_cast<int>(boxes.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(boxes.size()); ++b) {
      const double margin = std::min(max, std::max(base, scene.motion[a].reach + scene.motion[b].reach));
      const double range = margin + reach(a) - scene.motion[a].reach + reach(b) - scene.motion[b].reach;
      if (boxes[a].exteriorDistance(boxes[b]) <= range) pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

TEST(BroadPhase, ManyBoxesOfAllSizesFindTheSamePairsAsEachWithEachOther) {
  geometry::RandomShapes random(7);
  const Collider sizes[] = {makeCollider(geometry::boxMesh(Vector3::Constant(0.02)), 0.001), box(0.002),
                            makeCollider(geometry::boxMesh({0.05, 3, 0.4}), 0), makeCollider(geometry::gridMesh(20, 20, 1, 1), 0),
                            makeCollider(geometry::pointMesh(Vector3::Zero()), 0)};
  for (int round = 0; round < 12; ++round) {
    PlacedBoxes scene;
    const int count = 65 + 40 * round, shapes = 1 + round % 5;
    const Vector3 spread = round % 3 == 0 ? Vector3(2, 2, 0.01) : round % 3 == 1 ? Vector3(0.01, 0.01, 5) : Vector3(0.5, 1, 0.5);
    for (int i = 0; i < count; ++i) {
      const int shape = round == 4 ? 4 : i % 17 == 0 ? static_cast<int>(i / 17 % shapes) : i % std::min(2, shapes);
      Vector3 place = random.point(1).cwiseProduct(spread);
      if (i % 50 == 49) place *= 1e7;  // strayed
      scene.add(sizes[shape], makePose(place, shape == 3 ? Vector3::Zero() : random.point(3)), i, i, random.uniform(0, 0.01));
    }
    EXPECT_EQ(scene.pairs({}, 0.001, 0.015), everyPair(scene, 0.001, 0.015)) << round;
  }
}

TEST(BroadPhase, ComparesEachOfManyBoxesWithFewOthersInLayersAndHeaps) {
  constexpr int COUNT = 20000;
  for (const int axes : {2, 3}) {
    PlacedBoxes scene;
    int side = 1;
    while (std::pow(side, axes) < COUNT) ++side;
    for (int i = 0; i < COUNT; ++i)
      scene.add(box(0.002), makePose(0.11 * Vector3(i % side, i / side % side, axes == 3 ? i / side / side : 0)), i, i);
    BroadPhase search;
    EXPECT_TRUE(search.find(scene.colliders, scene.motion, {}, 0.001, 0.1).empty());
    // A sweep along one axis alone compares 141 times COUNT in the layer, 756 times in the heap.
    EXPECT_LT(search.compared(), 16 * COUNT) << axes;
  }
}

TEST(BroadPhase, LeavesOutWhatIsFar) {
  PlacedBoxes scene;
  scene.add(box(0.002), makePose({0, 0, 0}), 0, 0);
  scene.add(box(0.002), makePose({0.1049, 0, 0}), 1, 1);
  scene.add(box(0.002), makePose({0.1049, 0.1051, 0}), 2, 2);
  scene.add(makeHalfSpace({0, 0, 1}, -0.053), Pose::Identity(), -1, 3);
  scene.add(makeHalfSpace({0, 0, 1}, -0.0531), Pose::Identity(), -1, 4);
  EXPECT_EQ(scene.pairs(), (Pairs{{0, 1}, {0, 3}, {1, 3}, {2, 3}}));
}

TEST(BroadPhase, MarginFollowsTheMotionUpToItsBound) {
  PlacedBoxes scene;
  scene.add(box(), makePose({0, 0, 0}), 0, 0, 0.01);
  scene.add(box(), makePose({0.125, 0, 0}), 1, 1, 0.02);
  ASSERT_EQ(scene.pairs(), (Pairs{{0, 1}}));
  EXPECT_DOUBLE_EQ(BroadPhase().find(scene.colliders, scene.motion, {}, 0.001, 0.1)[0].margin, 0.03);
  EXPECT_TRUE(scene.pairs({}, 0.001, 0.02).empty());
  EXPECT_DOUBLE_EQ(BroadPhase().find(scene.colliders, scene.motion, {}, 0.04, 0.1)[0].margin, 0.04);
}

TEST(BroadPhase, StateThatIsNotFiniteIsLeftOut) {
  PlacedBoxes scene;
  for (int i = 0; i < 3; ++i) scene.add(box(), makePose({0.05 * i, 0, 0}), i, i);
  scene.motion[1].X_WC.translation().x() = std::nan("");
  EXPECT_EQ(scene.pairs(), (Pairs{{0, 2}}));
}

TEST(CollisionFilter, WhoMayTouchWhom) {
  const auto collider = [](int body, int model) {
    Collider c;
    c.body = body;
    c.model = model;
    return c;
  };
  CollisionFilter filter;
  const Collider hand = collider(1, 0), arm = collider(2, 0), cup = collider(3, 1), floor = collider(-1, 2), wall = collider(-1, 3);
  EXPECT_FALSE(filter.allows(floor, wall));
  EXPECT_FALSE(filter.allows(hand, arm));
  EXPECT_TRUE(filter.allows(hand, cup));
  EXPECT_TRUE(filter.allows(hand, floor));
  filter.setSelfCollision(0, true);
  EXPECT_TRUE(filter.allows(hand, arm));
  EXPECT_FALSE(filter.allows(hand, hand));
  filter.disableBodies(2, 1);
  EXPECT_FALSE(filter.allows(hand, arm));
  EXPECT_FALSE(filter.allows(arm, hand));
  filter.setSelfCollision(0, false);
  EXPECT_FALSE(filter.allows(hand, arm));
  Collider sole = collider(4, 0), shin = collider(5, 0), thigh = collider(6, 0);
  sole.link = 1;
  shin.link = 2;
  thigh.link = 3;
  filter.setSelfCollidingLinks(0, {1});
  EXPECT_TRUE(filter.allows(sole, thigh));
  EXPECT_TRUE(filter.allows(shin, sole));
  EXPECT_FALSE(filter.allows(shin, thigh));
  EXPECT_TRUE(filter.allows(shin, cup));
  filter.setSelfCollidingLinks(0, {});
  EXPECT_FALSE(filter.allows(sole, thigh));
  filter.setSelfCollision(0, true);
  EXPECT_TRUE(filter.allows(shin, thigh));
  filter.setSelfCollision(0, false);
  Collider unloaded = cup;
  unloaded.enabled = false;
  EXPECT_FALSE(filter.allows(hand, unloaded));
}

}  // namespace
}  // namespace blem_sim::contact
