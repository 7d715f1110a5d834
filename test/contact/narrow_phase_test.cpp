// Poses whose contacts are known in closed form.
#include <gtest/gtest.h>

#include <set>

#include "blem_sim/reduction/reduction.h"
#include "contact/contact_shapes.h"
#include "features/mesh_pair.h"

namespace blem_sim::contact {
namespace {

constexpr double EDGE = 0.1;  // of the cubes

Collider cube(double radius) { return makeCollider(geometry::boxMesh(Vector3::Constant(EDGE)), radius); }
Pose at(double x, double y, double z) { return makePose({x, y, z}); }

/** Every contact of A, which lies above, points up and is `gap` high. */
void expectUp(const ContactManifold& manifold, double gap, double tolerance = 1e-12) {
  for (const Contact& c : manifold.contacts) {
    EXPECT_NEAR((c.normal_BA - Vector3::UnitZ()).norm(), 0, tolerance);
    EXPECT_NEAR(c.depth, manifold.layer - gap, tolerance);
  }
}

TEST(NarrowPhase, AlignedCubesHaveFourContacts) {
  const ContactManifold manifold = contactsOf(cube(0.003), at(0, 0, EDGE + 0.004), cube(0.002), Pose::Identity());
  ASSERT_EQ(manifold.contacts.size(), 4u);
  EXPECT_DOUBLE_EQ(manifold.layer, 0.005);
  EXPECT_FALSE(manifold.pierced);
  expectUp(manifold, 0.004);
  for (const Contact& c : manifold.contacts) {
    EXPECT_NEAR(std::abs(c.point.x()), EDGE / 2, 1e-12);
    EXPECT_NEAR(std::abs(c.point.y()), EDGE / 2, 1e-12);
    // Layers end at 0.052 and 0.051: the middle of their overlap.
    EXPECT_NEAR(c.point.z(), 0.0515, 1e-12);
  }
}

TEST(NarrowPhase, WhatAManifoldHeldDoesNotMatter) {
  geometry::RandomShapes random(2);
  const Collider hills = makeCollider(hillMesh(random, 0.4, 20, 0.001), 0.002), ground = makeHalfSpace(Vector3::UnitZ(), 0);
  const Pose above = at(0, 0, EDGE / 2 + 0.002), crossing = at(0, 0, EDGE / 2 - 0.002);
  for (const Collider* standing : {&hills, &ground}) {
    for (const Pose& X_WA : {above, crossing}) {
      const ContactManifold fresh = contactsOf(cube(0.003), X_WA, *standing, Pose::Identity());
      EXPECT_FALSE(fresh.contacts.empty());
      for (const std::size_t held : {3, 5000}) {
        Contact other;
        other.weight = 0.5;
        other.pierced = true;
        ContactManifold manifold;
        manifold.contacts.assign(held, other);
        narrowPhase({cube(0.003), X_WA}, {*standing, Pose::Identity()}, {0}, searchRoom(), &manifold);
        ASSERT_EQ(manifold.contacts.size(), fresh.contacts.size());
        for (std::size_t i = 0; i < fresh.contacts.size(); ++i) {
          EXPECT_EQ(manifold.contacts[i].id, fresh.contacts[i].id);
          EXPECT_EQ(manifold.contacts[i].point, fresh.contacts[i].point);
          EXPECT_EQ(manifold.contacts[i].weight, 1);
          EXPECT_EQ(manifold.contacts[i].pierced, fresh.contacts[i].pierced);
        }
      }
    }
  }
}

TEST(NarrowPhase, CubesSlightlyOffHaveFourCorners) {
  for (const double offset : {1e-6, 1e-5, 1e-3}) {
    ContactManifold manifold = contactsOf(cube(0.0025), at(offset, 0.7 * offset, EDGE + 0.004), cube(0.0025), Pose::Identity());
    EXPECT_EQ(manifold.contacts.size(), 4u) << offset;
    expectUp(manifold, 0.004);
    reduction::reduceHull(manifold.contacts, 20);
    EXPECT_EQ(manifold.contacts.size(), 4u) << offset;
  }
}

TEST(NarrowPhase, TurnedCubesHaveEightCorners) {
  ContactManifold manifold = contactsOf(cube(0.0025), makePose({0, 0, EDGE + 0.004}, {0, 0, M_PI / 4}), cube(0.0025), Pose::Identity());
  expectUp(manifold, 0.004);
  reduction::reduceHull(manifold.contacts, 20);
  EXPECT_EQ(manifold.contacts.size(), 8u);
}

TEST(NarrowPhase, TessellationOfThePlaneDoesNotMatter) {
  for (const int cells : {1, 7, 60}) {
    for (const double tilt : {0.0, 0.002}) {
      const Pose X_WA = makePose({0.013, 0.021, EDGE / 2 + 0.002}, {tilt, 0.4 * tilt, 0.3});
      const ContactManifold manifold =
          contactsOf(cube(0.0025), X_WA, makeCollider(geometry::gridMesh(1, 1, cells, cells), 0), Pose::Identity());
      ASSERT_EQ(manifold.contacts.size(), 4u) << cells << " cells, tilt " << tilt;
      for (const Contact& c : manifold.contacts) EXPECT_NEAR((c.normal_BA - Vector3::UnitZ()).norm(), 0, 1e-12);
    }
  }
}

TEST(NarrowPhase, TessellationOfTheCubeDoesNotMatterAfterReduction) {
  const Collider fine = makeCollider(geometry::subdivided(geometry::boxMesh(Vector3::Constant(EDGE)), 3), 0.0025);
  ContactManifold manifold = contactsOf(fine, at(0.01, 0.02, EDGE + 0.003), fine, Pose::Identity());
  expectUp(manifold, 0.003);
  EXPECT_LT(manifold.contacts.size(), 50u);  // nothing from inside the faces
  reduction::reduceHull(manifold.contacts, 20);
  EXPECT_EQ(manifold.contacts.size(), 4u);
}

TEST(NarrowPhase, SpeculativeContactsHaveNegativeDepth) {
  const ContactManifold manifold = contactsOf(cube(0.002), at(0, 0, EDGE + 0.0055), cube(0.003), Pose::Identity(), 0.001);
  ASSERT_EQ(manifold.contacts.size(), 4u);
  expectUp(manifold, 0.0055);
  EXPECT_NEAR(manifold.maxDepth(), -0.0005, 1e-12);
  EXPECT_TRUE(contactsOf(cube(0.002), at(0, 0, EDGE + 0.0061), cube(0.003), Pose::Identity(), 0.001).contacts.empty());
}

TEST(NarrowPhase, SphereOnPlaneBoxEdgeAndCorner) {
  const double r = 0.03, gap = 0.025;
  const Collider sphere = makeCollider(geometry::pointMesh(Vector3::Zero()), r);
  const Collider plane = makeCollider(geometry::gridMesh(1, 1, 10, 10), 0.002), box = cube(0.002);
  const auto expectOne = [&](const Collider& on, const Vector3& centre, const Vector3& foot) {
    const ContactManifold manifold = contactsOf(sphere, makePose(centre), on, Pose::Identity());
    ASSERT_EQ(manifold.contacts.size(), 1u);
    const Contact& c = manifold.contacts[0];
    const double distance = (centre - foot).norm();
    const Vector3 normal = (centre - foot) / distance;
    EXPECT_NEAR((c.normal_BA - normal).norm(), 0, 1e-12);
    EXPECT_NEAR(c.depth, 0.032 - distance, 1e-12);
    EXPECT_NEAR((c.point - (0.5 * (centre + foot) + normal * 0.5 * (0.002 - r))).norm(), 0, 1e-12);
  };
  const double h = EDGE / 2;
  expectOne(plane, {0.123, -0.201, gap}, {0.123, -0.201, 0});
  expectOne(plane, {0.1, -0.2, -gap}, {0.1, -0.2, 0});  // from below, over a vertex of the plane
  expectOne(plane, {0.51, 0.02, 0.01}, {0.5, 0.02, 0});
  expectOne(box, {0.01, 0.02, h + gap}, {0.01, 0.02, h});
  expectOne(box, {0.01, h + 0.01, h + 0.02}, {0.01, h, h});
  expectOne(box, {h + 0.01, h + 0.015, -h - 0.01}, {h, h, -h});
}

TEST(NarrowPhase, BallsRollAndEdgesDoNot) {
  const Collider ball = makeCollider(geometry::pointMesh(Vector3::Zero()), 0.03),
                 small = makeCollider(geometry::pointMesh(Vector3::Zero()), 0.02), floor = makeHalfSpace(Vector3::UnitZ(), 0, 0.002),
                 box = cube(0.002);
  const auto rolling = [](const Collider& a, const Vector3& p, const Collider& b) {
    const ContactManifold manifold = contactsOf(a, makePose(p), b, Pose::Identity());
    EXPECT_FALSE(manifold.contacts.empty());
    return manifold.contacts.empty() ? NAN : rollingRadius(a, b, manifold.contacts[0]);
  };
  const double h = EDGE / 2;
  EXPECT_NEAR(rolling(ball, {0, 0, 0.032}, floor), 0.03, 1e-15);
  EXPECT_NEAR(rolling(ball, {0, 0, 0.030}, floor), 0.029, 1e-12);  // half of the depth is the ball's
  EXPECT_NEAR(rolling(ball, {0.01, 0.02, h + 0.032}, box), 0.03, 1e-12);
  EXPECT_NEAR(rolling(box, {-0.01, -0.02, -h - 0.032}, ball), 0.03, 1e-12);
  EXPECT_NEAR(rolling(ball, {0, 0, 0.05}, small), 0.012, 1e-12);
  EXPECT_EQ(rolling(ball, {0.01, h + 0.01, h + 0.02}, box), 0);  // an edge
  EXPECT_EQ(rolling(box, {0, 0, h + 0.0035}, floor), 0);
}

TEST(NarrowPhase, SpheresAndCapsules) {
  const Collider sphere = makeCollider(geometry::pointMesh({0.001, 0, 0}), 0.03),
                 ball = makeCollider(geometry::pointMesh(Vector3::Zero()), 0.02);
  const Collider capsule = makeCollider(geometry::segmentMesh({-0.1, 0, 0}, {0.1, 0, 0}), 0.01);
  ContactManifold manifold = contactsOf(sphere, at(0.029, 0, 0.04), ball, Pose::Identity());
  ASSERT_EQ(manifold.contacts.size(), 1u);
  EXPECT_NEAR(manifold.contacts[0].depth, 0, 1e-15);
  EXPECT_NEAR((manifold.contacts[0].normal_BA - Vector3(0.6, 0, 0.8)).norm(), 0, 1e-12);

  manifold = contactsOf(capsule, at(0, 0, 0.025), ball, at(0.05, 0, 0));
  ASSERT_EQ(manifold.contacts.size(), 1u);
  EXPECT_NEAR(manifold.contacts[0].depth, 0.005, 1e-12);

  // Crosswise capsules: the common perpendicular. Parallel ones: the ends that overlap.
  manifold = contactsOf(capsule, at(0, 0, 0.015), capsule, makePose({0, 0.03, 0}, {0, 0, M_PI / 2}));
  ASSERT_EQ(manifold.contacts.size(), 1u);
  EXPECT_NEAR(manifold.contacts[0].depth, 0.005, 1e-12);
  EXPECT_NEAR(manifold.contacts[0].point.head<2>().norm(), 0, 1e-12);
  manifold = contactsOf(capsule, at(0.04, 0, 0.015), capsule, Pose::Identity());
  ASSERT_EQ(manifold.contacts.size(), 2u);
  expectUp(manifold, 0.015);

  // The axis lies along a plane: both ends.
  manifold = contactsOf(capsule, at(0, 0, 0.008), makeCollider(geometry::gridMesh(1, 1, 20, 20), 0), Pose::Identity());
  ASSERT_EQ(manifold.contacts.size(), 2u);
  expectUp(manifold, 0.008);
}

TEST(NarrowPhase, CloudOnMesh) {
  geometry::RandomShapes random(5);
  std::vector<Vector3> points;
  for (int i = 0; i < 200; ++i) points.push_back({random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(0, 0.02)});
  const Collider cloud = makeCollider(geometry::pointCloudMesh(points, nullptr), 0.01),
                 plane = makeCollider(geometry::gridMesh(1, 1, 9, 9), 0);
  const ContactManifold manifold = contactsOf(cloud, Pose::Identity(), plane, Pose::Identity());
  EXPECT_EQ(manifold.contacts.size(), std::count_if(points.begin(), points.end(), [](const Vector3& p) { return p.z() <= 0.01; }));
  for (const Contact& c : manifold.contacts) EXPECT_NEAR((c.normal_BA - Vector3::UnitZ()).norm(), 0, 1e-12);
}

TEST(NarrowPhase, HalfSpaceInEitherOrder) {
  const Collider half_space = makeHalfSpace({0, 0, 2}, 0.25, 0.001),
                 box = makeCollider(geometry::subdivided(geometry::boxMesh(Vector3::Constant(EDGE)), 1), 0.003);
  // Deep, shallow and speculative contacts; the plane turned with its frame.
  for (const double gap : {-0.03, 0.002, 0.0045}) {
    const Pose X_WH = makePose({1, 2, 3}, {0.3, -0.8, 0.5}), X_WA = X_WH * makePose({0.2, 0.1, 0.25 + EDGE / 2 + gap}, {0, 0, 0.4});
    const ContactManifold above = contactsOf(box, X_WA, half_space, X_WH, 0.001);
    ContactManifold below = contactsOf(half_space, X_WH, box, X_WA, 0.001);
    EXPECT_FALSE(above.pierced);
    ASSERT_EQ(above.contacts.size(), 4u) << gap;  // vertices of the subdivision lie inside the bottom's sides
    for (const Contact& c : above.contacts) {
      EXPECT_NEAR((c.normal_BA - X_WH.linear().col(2)).norm(), 0, 1e-12);
      EXPECT_NEAR(c.depth, 0.004 - gap, 1e-12);
      EXPECT_NEAR((X_WH.inverse() * c.point).z(), 0.25 + gap / 2 + 0.5 * (0.001 - 0.003), 1e-12);
      EXPECT_FALSE(c.pierced);
    }
    for (Contact& c : below.contacts) c.normal_BA = -c.normal_BA;
    EXPECT_EQ(above.contacts.size(), below.contacts.size());
    EXPECT_NEAR(largestDifference(above.contacts, below.contacts), 0, 1e-12);
  }
  EXPECT_TRUE(contactsOf(half_space, Pose::Identity(), half_space, at(0, 0, 0.1)).contacts.empty());
  const Collider sphere = makeCollider(geometry::pointMesh(Vector3::Zero()), 0.05);
  EXPECT_NEAR(contactsOf(sphere, at(0, 0, 0.27), half_space, Pose::Identity()).maxDepth(), 0.031, 1e-12);
}

/** Bare meshes that touch exactly have no direction between them; their surfaces give it. */
TEST(NarrowPhase, ExactTouchPointsOut) {
  const Collider bare = cube(0), plane = makeCollider(geometry::gridMesh(1, 1, 5, 5), 0);
  for (const double gap : {0.0, 1e-17, 1e-12, -1e-12, 1e-9, -1e-10}) {
    for (const Pose& X_WA :
         {at(0, 0, EDGE + gap), at(0.03, 0.02, EDGE + gap), makePose({0.03, 0, EDGE + gap}, {0, 0, 0.3}), at(EDGE / 2, 0, EDGE + gap)}) {
      ContactManifold manifold = contactsOf(bare, X_WA, bare, Pose::Identity(), 1e-6);
      EXPECT_FALSE(manifold.pierced);
      EXPECT_GE(manifold.contacts.size(), 4u);
      for (const Contact& c : manifold.contacts) EXPECT_NEAR((c.normal_BA - Vector3::UnitZ()).norm(), 0, 1e-6) << gap;
      manifold = contactsOf(plane, Pose::Identity(), bare, X_WA * at(0, 0, -EDGE / 2), 1e-6);
      EXPECT_FALSE(manifold.pierced);
      EXPECT_EQ(manifold.contacts.size(), 4u);
      for (const Contact& c : manifold.contacts) EXPECT_NEAR((c.normal_BA + Vector3::UnitZ()).norm(), 0, 1e-6) << gap;
    }
  }
}

/** Their gap is 0, though the search that tells their sides apart moves one of them a little. */
TEST(NarrowPhase, CopiesOfASheetAtOnePlaceTouch) {
  const Collider segment = makeCollider(geometry::segmentMesh({-0.5 * EDGE, 0, 0}, {0.5 * EDGE, 0, 0}), 0.004);
  const Collider coarse = makeCollider(geometry::gridMesh(EDGE, EDGE, 2, 2), 0.004),
                 fine = makeCollider(geometry::gridMesh(EDGE, EDGE, 4, 4), 0.001);
  const std::pair<const Collider*, const Collider*> pairs[] = {
      {&segment, &segment}, {&coarse, &coarse}, {&coarse, &fine}, {&fine, &coarse}};
  for (const auto& [a, b] : pairs) {
    for (const Vector3& turn : {Vector3(0, 0, 0), Vector3(0, 0, M_PI), Vector3(M_PI, 0, 0)}) {
      const Pose X_WB = makePose({1, 2, 3}, {0.3, -0.2, 0.5});
      const ContactManifold manifold = contactsOf(*a, X_WB * makePose(Vector3::Zero(), turn), *b, X_WB);
      EXPECT_FALSE(manifold.contacts.empty());
      EXPECT_FALSE(manifold.pierced);
      EXPECT_NEAR(manifold.maxDepth(), manifold.layer, 1e-12);
      for (const Contact& contact : manifold.contacts) EXPECT_LE(contact.depth, manifold.layer + 1e-12);
    }
  }
}

TEST(NarrowPhase, ContactsHaveUniqueIdsWhichLast) {
  geometry::RandomShapes random(11);
  const Collider hills = makeCollider(hillMesh(random, 0.5, 40, 0.001), 0), box = cube(0.005);
  Pose X_WA = makePose({0.013, 0.007, EDGE / 2 + 0.003}, {0.001, 0.002, 0.4});
  std::set<std::uint64_t> before;
  for (int step = 0; step < 20; ++step) {
    const ContactManifold manifold = contactsOf(box, X_WA, hills, Pose::Identity());
    ASSERT_GT(manifold.contacts.size(), 20u);
    std::set<std::uint64_t> ids;
    for (const Contact& c : manifold.contacts) EXPECT_TRUE(ids.insert(c.id).second) << c.id;
    std::vector<std::uint64_t> kept;
    std::set_intersection(ids.begin(), ids.end(), before.begin(), before.end(), std::back_inserter(kept));
    EXPECT_GE(kept.size() + 2, before.size());
    before = ids;
    X_WA.pretranslate(Vector3(1e-7, 0.5e-7, 0));
  }
}

TEST(NarrowPhase, SlidingOverATessellatedPlaneKeepsTheIds) {
  const Collider plane = makeCollider(geometry::gridMesh(1, 1, 100, 100), 0), box = cube(0.005);
  std::set<std::uint64_t> first;
  for (int step = 0; step < 50; ++step) {
    const ContactManifold manifold = contactsOf(box, at(0.001 * step, 0.0007 * step, EDGE / 2 + 0.004), plane, Pose::Identity());
    ASSERT_EQ(manifold.contacts.size(), 4u);
    std::set<std::uint64_t> ids;
    for (const Contact& c : manifold.contacts) ids.insert(c.id);
    if (step == 0) first = ids;
    EXPECT_EQ(ids, first);
  }
}

/** A plane with a notch: over one of its faces, beside another across the notch, where nothing but this takes over. */
TEST(NarrowPhase, AVertexOverAPlaneDoesNotFadeBesideAnotherOfItsFaces) {
  geometry::TriangleMesh plane;
  const double xs[] = {-0.05, 0, 0.001, 0.05}, ys[] = {-0.05, 0, 0.1};
  for (const double y : ys)
    for (const double x : xs) plane.vertices.emplace_back(x, y, 0);
  for (const int corner : {0, 1, 2, 4, 6}) {
    plane.elements.emplace_back(corner, corner + 1, corner + 5);
    plane.elements.emplace_back(corner, corner + 5, corner + 4);
  }
  const Vector3 tip(0.0012, 0.02, 0.0005);
  const geometry::TriangleMesh blade{{tip, tip + Vector3(0, 0.004, -0.0004), tip + Vector3(0, 0.004, 0.002)}, {{0, 1, 2}}};
  const Collider a = makeCollider(blade, 0.002), b = makeCollider(plane, 0.002);
  const ContactManifold manifold = contactsOf(a, Pose::Identity(), b, Pose::Identity());
  int of_tip = 0;
  for (const Contact& c : manifold.contacts) {
    if (c.id >> 30 != contactId({FeatureKind::VERTEX, 0}, {FeatureKind::FACE, 0}) >> 30) continue;
    ++of_tip;
    EXPECT_NEAR(c.depth, 0.0035, 1e-12);
  }
  EXPECT_EQ(of_tip, 1);
}

}  // namespace
}  // namespace blem_sim::contact
