// Memory of the narrow phase saves time and changes nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "contact/contact_shapes.h"

namespace blem_sim::contact {
namespace {

constexpr double KEPT_WIDTH = 0.002;

bool sameBits(const Contact& a, const Contact& b) {
  return a.id == b.id && a.pierced == b.pierced && std::memcmp(a.point.data(), b.point.data(), sizeof(Vector3)) == 0 &&
         std::memcmp(a.normal_BA.data(), b.normal_BA.data(), sizeof(Vector3)) == 0 && a.depth == b.depth;
}

Collider cubeOfWidth(double width) { return makeCollider(geometry::boxMesh(Vector3::Constant(width)), KEPT_WIDTH); }

/** Along a path, contacts with and without a memory. @return their number, and whether meshes crossed and did not */
struct Followed {
  std::size_t contacts = 0;
  bool crossed = false, apart = false;
};
Followed follow(const Collider& a, const Collider& b, int steps, const std::function<Pose(int)>& path,
                const std::function<double(int)>& margin) {
  NarrowPhaseMemory memory;
  ContactManifold remembered, fresh;
  Followed out;
  for (int step = 0; step < steps; ++step) {
    const Pose X = path(step);
    narrowPhase({a, X}, {b, Pose::Identity()}, {margin(step), nullptr, &memory}, searchRoom(), &remembered);
    narrowPhase({a, X}, {b, Pose::Identity()}, {margin(step)}, searchRoom(), &fresh);
    EXPECT_EQ(remembered.pierced, fresh.pierced) << step;
    if (remembered.contacts.size() != fresh.contacts.size()) {
      ADD_FAILURE() << "step " << step << ": " << remembered.contacts.size() << " contacts instead of " << fresh.contacts.size();
      return out;
    }
    for (std::size_t i = 0; i < fresh.contacts.size(); ++i) EXPECT_TRUE(sameBits(remembered.contacts[i], fresh.contacts[i])) << step;
    out.contacts += fresh.contacts.size();
    out.crossed = out.crossed || fresh.pierced;
    out.apart = out.apart || !fresh.pierced;
  }
  return out;
}

/** Path of a mesh that wanders and turns about its place, some 10 um to 1 mm a step. */
std::function<Pose(int)> wandering(const Vector3& place, double reach, double speed) {
  return [=](int step) {
    const double t = speed * step;
    return makePose(place + reach * Vector3(std::sin(t), std::cos(1.3 * t), std::sin(0.7 * t)),
                    {0.1 * std::sin(0.9 * t), 0.1 * std::sin(1.1 * t), 0.5 * std::sin(0.3 * t)});
  };
}

double noMargin(int) { return 0; }

TEST(NarrowPhaseMemory, ContactsAreTheSameBits) {
  geometry::RandomShapes random(5);
  const Collider hills = makeCollider(hillMesh(random, 0.3, 60, 0.001), 0),
                 cube = makeCollider(geometry::boxMesh(Vector3::Constant(0.05)), KEPT_WIDTH),
                 ball = makeCollider(geometry::icosphereMesh(0.02, 3), KEPT_WIDTH),
                 soup = makeCollider(soupMesh(random, 60, 0.02), KEPT_WIDTH);
  for (const double speed : {0.001, 0.02, 0.2}) {
    EXPECT_GT(follow(cube, hills, 300, wandering({0, 0, 0.026}, 0.004, speed), noMargin).contacts, 300u);
    EXPECT_GT(follow(ball, hills, 300, wandering({0, 0, 0.0215}, 0.003, speed), noMargin).contacts, 300u);
    EXPECT_GT(follow(soup, cube, 300, wandering({0.02, 0.01, 0.03}, 0.01, speed), noMargin).contacts, 300u);
  }
}

TEST(NarrowPhaseMemory, JerksAreNoSurprise) {
  geometry::RandomShapes random(9);
  const Collider hills = makeCollider(hillMesh(random, 0.3, 60, 0.001), 0),
                 ball = makeCollider(geometry::icosphereMesh(0.02, 3), KEPT_WIDTH);
  std::vector<Pose> path = {makePose({0, 0, 0.0215})};
  // The same way for some steps, then, up to ten thousand times slower or faster, another.
  for (int jerk = 0; jerk < 80; ++jerk) {
    const double speed = 3e-4 * std::pow(10, random.uniform(-4, 0));
    const Vector3 shift = speed * Vector3(random.uniform(-1, 1), random.uniform(-1, 1), 0);
    for (int step = 0; step < 2 + jerk % 9; ++step) path.push_back(Eigen::Translation3d(shift) * path.back());
  }
  const int steps = static_cast<int>(path.size());
  EXPECT_GT(follow(
                ball, hills, steps, [&](int step) { return path[step]; }, noMargin)
                .contacts,
            300u);
}

/** Pairs that had no candidates for a while. */
TEST(NarrowPhaseMemory, FromAfarByTurningAndByJumping) {
  const Collider ground = makeCollider(geometry::gridMesh(2, 2, 20, 20), 0),
                 pole = makeCollider(geometry::boxMesh({1, 0.01, 0.01}), KEPT_WIDTH),
                 cube = makeCollider(geometry::boxMesh(Vector3::Constant(0.05)), KEPT_WIDTH);
  const auto tilting = [](int step) { return makePose({0, 0, 0.02}, {0, 2e-4 * step, 0}); };
  EXPECT_GT(follow(pole, ground, 150, tilting, noMargin).contacts, 10u);
  const auto jumping = [](int step) { return makePose({1e-6 * step, 0, step < 20 ? 0.03 : 0.022}); };
  EXPECT_TRUE(follow(cube, ground, 25, jumping, noMargin).crossed);
}

TEST(NarrowPhaseMemory, CrossingsAreFoundAndLost) {
  geometry::RandomShapes random(6);
  const Collider hills = makeCollider(hillMesh(random, 0.3, 60, 0.001), 0),
                 ball = makeCollider(geometry::icosphereMesh(0.02, 3), KEPT_WIDTH);
  for (const double speed : {0.002, 0.05}) {
    const Followed found = follow(ball, hills, 1500, wandering({0, 0, 0.019}, 0.004, speed), noMargin);
    EXPECT_TRUE(found.crossed);
    EXPECT_TRUE(found.apart);
  }
}

/** The only contact is that of two edges, well away from their ends, until they pass through each other. */
TEST(NarrowPhaseMemory, EdgesThatMeetAreFound) {
  geometry::TriangleMesh ridge = geometry::boxMesh({0.02, 0.1, 0.02});
  for (Vector3& v : ridge.vertices) v = makePose(Vector3::Zero(), {0, M_PI / 4, 0}) * v;
  const Collider below = makeCollider(ridge, 0), above = makeCollider(geometry::boxMesh({0.1, 0.02, 0.02}), KEPT_WIDTH);
  const double touch = 0.02 * std::sqrt(2.0);
  const auto path = [&](int step) { return makePose({0.001, 0.002, touch + 0.001 - 3e-4 * step}, {M_PI / 4, 0, 0}); };
  const Followed found = follow(above, below, 8, path, noMargin);
  EXPECT_TRUE(found.crossed);
  EXPECT_TRUE(found.apart);
}

/** A cube runs into a step of a floor, along which it slides at one height, farther in every step than it is above the floor. */
TEST(NarrowPhaseMemory, WhatSlidesIntoAStepIsFound) {
  geometry::TriangleMesh floor = geometry::gridMesh(0.3, 0.3, 60, 60);
  for (Vector3& v : floor.vertices) v.z() = v.x() > 0.101 ? 0.004 : 0;
  const Collider ground = makeCollider(floor, 0), cube = makeCollider(geometry::boxMesh(Vector3::Constant(0.05)), 0.0005);
  for (const double speed : {1e-4, 2e-4, 5e-4}) {
    const auto path = [=](int step) { return makePose({0.06 + speed * step, 0, 0.02505}); };
    const Followed found = follow(cube, ground, static_cast<int>(0.025 / speed), path, noMargin);
    EXPECT_TRUE(found.crossed);
    EXPECT_TRUE(found.apart);
  }
}

TEST(NarrowPhaseMemory, MarginsMayChange) {
  geometry::RandomShapes random(7);
  const Collider hills = makeCollider(hillMesh(random, 0.3, 60, 0.001), 0),
                 cube = makeCollider(geometry::boxMesh(Vector3::Constant(0.05)), KEPT_WIDTH);
  const auto margin = [](int step) { return 0.001 * (1 + std::sin(0.3 * step)); };
  EXPECT_GT(follow(cube, hills, 300, wandering({0, 0, 0.027}, 0.003, 0.01), margin).contacts, 300u);
}

/** A chip, its lists made in straight flight, turns on the spot until edges have contacts that had none: little moves, but much turns. */
TEST(NarrowPhaseMemory, TurningOnTheSpot) {
  geometry::RandomShapes random(10);
  const Collider hills = makeCollider(hillMesh(random, 0.02, 40, 0.0001), 0),
                 chip = makeCollider(hillMesh(random, 0.001, 4, 0.0001), KEPT_WIDTH);
  const auto path = [](int step) {
    const int turned = std::max(0, step - 5) % 40;
    return makePose({-1.5e-4 * std::max(0, 5 - step), 0, 0.0008}, {0.01 * turned, 0, 0.02 * turned});
  };
  EXPECT_GT(follow(chip, hills, 25, path, noMargin).contacts, 300u);
}

TEST(NarrowPhaseMemory, FarFromTheOriginToo) {
  geometry::RandomShapes random(8);
  geometry::TriangleMesh far = hillMesh(random, 0.3, 40, 0.001);
  for (Vector3& v : far.vertices) v += Vector3(90, -40, 3);
  const Collider hills = makeCollider(far, 0), cube = makeCollider(geometry::boxMesh(Vector3::Constant(0.05)), KEPT_WIDTH);
  EXPECT_GT(follow(cube, hills, 200, wandering({90, -40, 3.027}, 0.003, 0.02), noMargin).contacts, 200u);
}

TEST(NarrowPhaseMemory, AnotherGeometryIsNotTakenForTheOneBefore) {
  geometry::RandomShapes random(9);
  const Collider hills = makeCollider(hillMesh(random, 0.3, 60, 0.001), 0);
  const Pose X = makePose({0, 0, 0.0275});
  NarrowPhaseMemory memory;
  for (const double size : {0.05, 0.051, 0.05}) {
    const Collider cube = makeCollider(geometry::boxMesh(Vector3::Constant(size)), KEPT_WIDTH);
    NarrowPhaseMemory none;
    ContactManifold remembered, fresh;
    narrowPhase({cube, X}, {hills, Pose::Identity()}, {0, nullptr, &memory}, searchRoom(), &remembered);
    narrowPhase({cube, X}, {hills, Pose::Identity()}, {0, nullptr, &none}, searchRoom(), &fresh);
    ASSERT_GT(fresh.contacts.size(), 10u);
    ASSERT_EQ(remembered.contacts.size(), fresh.contacts.size());
    for (std::size_t i = 0; i < fresh.contacts.size(); ++i) EXPECT_TRUE(sameBits(remembered.contacts[i], fresh.contacts[i]));
  }
}

/** The path, with stops of four steps. */
std::function<Pose(int)> haltingly(const std::function<Pose(int)>& path) {
  return [=](int step) { return path(step - step % 5); };
}

TEST(NarrowPhaseMemory, StillPairsHaveTheSameBits) {
  geometry::RandomShapes random(10);
  const Collider hills = makeCollider(hillMesh(random, 0.3, 60, 0.001), 0), cube = cubeOfWidth(0.05);
  const Followed followed = follow(cube, hills, 200, haltingly(wandering({0, 0, 0.025}, 0.004, 0.02)), noMargin);
  EXPECT_GT(followed.contacts, 200u);
  EXPECT_TRUE(followed.crossed && followed.apart);
  EXPECT_GT(follow(cube, hills, 20, haltingly(wandering({0, 0, 0.027}, 0.001, 0.02)), [](int step) { return 1e-4 * (step % 2); }).contacts,
            200u);
}

/** Contacts of a cube on a plate, both still, with a memory that has seen them stand still. */
struct CubeAtRest {
  Collider cube = cubeOfWidth(0.05);
  Collider plate = makeCollider(geometry::boxMesh({0.3, 0.3, 0.02}), 0);
  Pose X_WC = makePose({0, 0, 0.0365});
  const Pose* X_AB_apart = nullptr;
  NarrowPhaseMemory memory;

  ContactManifold find(const Pose& X_WP, NarrowPhaseMemory* known) {
    ContactManifold found;
    narrowPhase({cube, X_WP * X_WC}, {plate, X_WP}, {0, X_AB_apart, known}, searchRoom(), &found);
    return found;
  }
  void expectFresh(const Pose& X_WP) {
    const ContactManifold remembered = find(X_WP, &memory), fresh = find(X_WP, nullptr);
    ASSERT_EQ(remembered.contacts.size(), fresh.contacts.size());
    ASSERT_FALSE(fresh.contacts.empty());
    for (std::size_t i = 0; i < fresh.contacts.size(); ++i) EXPECT_TRUE(sameBits(remembered.contacts[i], fresh.contacts[i]));
  }
  void rest() {
    for (int i = 0; i < 4; ++i) expectFresh(Pose::Identity());
  }
};

TEST(NarrowPhaseMemory, StillPairsKnowTheirLayersAndPlaces) {
  CubeAtRest at;
  at.rest();
  at.cube.radius *= 1.25;
  at.expectFresh(Pose::Identity());
  at.rest();
  std::swap(at.cube.radius, at.plate.radius);
  at.expectFresh(Pose::Identity());
  at.rest();
  at.expectFresh(makePose({0.1, 0, 0}));  // both are moved alike
}

TEST(NarrowPhaseMemory, StillPairsThatCrossKnowWhereTheyCameFrom) {
  CubeAtRest at;
  at.X_WC = makePose({0, 0, 0.03});
  const Pose above = makePose({0, 0, -0.05}), below = makePose({0, 0, 0.05});
  at.X_AB_apart = &above;
  at.rest();
  at.X_AB_apart = &below;
  at.expectFresh(Pose::Identity());
}

}  // namespace
}  // namespace blem_sim::contact
