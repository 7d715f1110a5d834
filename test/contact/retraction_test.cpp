// Beyond the layer: contacts of the fallback where bare meshes cross.
#include <gtest/gtest.h>

#include "blem_sim/geometry/shortest_turn.h"
#include "contact/contact_shapes.h"

namespace blem_sim::contact {
namespace {

constexpr double SIDE = 0.1;
constexpr double SUM_OF_WIDTHS = 0.005;

Collider retractedCube(int level = 0) {
  return makeCollider(geometry::subdivided(geometry::boxMesh(Vector3::Constant(SIDE)), level), SUM_OF_WIDTHS / 2);
}

int countPierced(const ContactManifold& manifold) {
  return std::count_if(manifold.contacts.begin(), manifold.contacts.end(), [](const Contact& c) { return c.pierced; });
}

/** For a cube sunk into another or a sheet, of any tessellations, depth grows past the layer and the direction stays. */
TEST(Retraction, SunkCubeIsPushedOutTheWayItCame) {
  struct Ground {
    const char* name;
    Collider collider;
    double top;
  };
  const std::vector<Ground> grounds = {{"cube", retractedCube(), SIDE / 2},
                                       {"fine cube", retractedCube(2), SIDE / 2},
                                       {"two triangles", makeCollider(geometry::gridMesh(1, 1, 1, 1), SUM_OF_WIDTHS / 2), 0},
                                       {"fine sheet", makeCollider(geometry::gridMesh(1, 1, 90, 90), SUM_OF_WIDTHS / 2), 0},
                                       {"block", makeCollider(geometry::boxMesh({1, 1, 0.2}), SUM_OF_WIDTHS / 2), 0.1}};
  for (const Ground& ground : grounds) {
    for (const int level : {0, 2}) {
      for (const Vector3& offset : {Vector3(0, 0, 0), Vector3(1e-6, 0, 0), Vector3(0.02, 0.013, 0), Vector3(0.0123, 0, 0)}) {
        for (const double sunk : {1e-7, 1e-4, 2e-3}) {
          const Pose X_WA = makePose(offset + Vector3(0, 0, ground.top + SIDE / 2 - sunk));
          const ContactManifold manifold = contactsOf(retractedCube(level), X_WA, ground.collider, Pose::Identity());
          SCOPED_TRACE(testing::Message() << ground.name << " level " << level << " offset " << offset.transpose() << " sunk " << sunk);
          EXPECT_TRUE(manifold.pierced);
          EXPECT_GE(countPierced(manifold), 4);
          EXPECT_NEAR(manifold.maxDepth(), SUM_OF_WIDTHS + sunk, 1e-9);
          for (const Contact& c : manifold.contacts) EXPECT_NEAR((c.normal_BA - Vector3::UnitZ()).norm(), 0, 1e-9);
        }
      }
    }
  }
}

/** Only the earlier pose of a cube that is sunk by more than half tells the side. */
TEST(Retraction, WayBackIsTheOneFromWhereThePairWasApart) {
  const Collider sheet = makeCollider(geometry::gridMesh(1, 1, 7, 7), SUM_OF_WIDTHS / 2);
  for (const double above : {1.0, -1.0}) {
    const Pose X_BA_apart = makePose({0.01, 0, above * (SIDE / 2 + SUM_OF_WIDTHS)}, {0, 0, 0.1});
    for (const double sunk : {0.001, 0.04, 0.08}) {
      const Pose X_WB = makePose({0.3, -0.2, 0.1}, {0.4, 0.3, 0.2}), X_BA = makePose({0.05, 0.02, above * (SIDE / 2 - sunk)}, {0, 0, 0.2});
      for (const bool a_is_cube : {true, false}) {
        SCOPED_TRACE(testing::Message() << "above " << above << " sunk " << sunk << " cube first " << a_is_cube);
        ContactManifold manifold;
        const Pose X_AB_apart = a_is_cube ? X_BA_apart.inverse() : X_BA_apart;
        if (a_is_cube) {
          narrowPhase({retractedCube(), X_WB * X_BA}, {sheet, X_WB}, {0, &X_AB_apart}, searchRoom(), &manifold);
        } else {
          narrowPhase({sheet, X_WB}, {retractedCube(), X_WB * X_BA}, {0, &X_AB_apart}, searchRoom(), &manifold);
        }
        EXPECT_TRUE(manifold.pierced);
        ASSERT_EQ(countPierced(manifold), 4);
        EXPECT_NEAR(manifold.maxDepth(), SUM_OF_WIDTHS + sunk, 1e-9);
        const Vector3 up = X_WB.linear() * Vector3(0, 0, a_is_cube ? above : -above);
        for (const Contact& c : manifold.contacts) EXPECT_NEAR((c.normal_BA - up).norm(), 0, 1e-9);
      }
    }
  }
}

/** A wedged body: walls that cross on both sides must not pull it apart. */
TEST(Retraction, DirectionsOfOnePairAgree) {
  geometry::RandomShapes random(33);
  int pierced = 0;
  for (int i = 0; i < 200; ++i) {
    const Collider a = makeCollider(hillMesh(random, 0.2, 6, 0.03), 0.001), b = makeCollider(octahedronMesh(0.04), 0.001);
    const ContactManifold manifold = contactsOf(b, random.pose(0.05), a, Pose::Identity());
    ASSERT_TRUE(allFinite(manifold));
    Vector3 mean = Vector3::Zero();
    for (const Contact& c : manifold.contacts) mean += c.pierced ? c.normal_BA : Vector3(Vector3::Zero());
    pierced += manifold.pierced;
    for (const Contact& c : manifold.contacts) EXPECT_TRUE(!c.pierced || c.normal_BA.dot(mean) > 0);
  }
  EXPECT_GT(pierced, 50);
}

TEST(Retraction, CornerAndEdgeThroughASheet) {
  const Collider sheet = makeCollider(geometry::gridMesh(1, 1, 20, 20), SUM_OF_WIDTHS / 2);
  const double corner = SIDE / 2 * std::sqrt(3.0), edge = SIDE / 2 * std::sqrt(2.0), sunk = 0.001;
  Pose X_WA = Pose::Identity();
  X_WA.linear() = geometry::shortestTurn(Vector3(1, 1, 1), Vector3(0, 0, -1)).toRotationMatrix();
  X_WA.translation() = Vector3(0.011, 0.007, corner - sunk);
  ContactManifold manifold = contactsOf(retractedCube(), X_WA, sheet, Pose::Identity());
  EXPECT_TRUE(manifold.pierced);
  ASSERT_EQ(countPierced(manifold), 1);  // three edges, one end
  EXPECT_NEAR(manifold.maxDepth(), SUM_OF_WIDTHS + sunk, 1e-12);
  manifold = contactsOf(retractedCube(), makePose({0, 0, edge - sunk}, {M_PI / 4, 0, 0.2}), sheet, Pose::Identity());
  EXPECT_EQ(countPierced(manifold), 2);
  EXPECT_NEAR(manifold.maxDepth(), SUM_OF_WIDTHS + sunk, 1e-12);
  for (const Contact& c : manifold.contacts) EXPECT_NEAR((c.normal_BA - Vector3::UnitZ()).norm(), 0, 1e-12);
}

/** Roof ridge across roof ridge: shorter over the ridge than back along it. */
TEST(Retraction, CrossedRidgesPartOverTheRidge) {
  const double h = SIDE / 2 * std::sqrt(2.0), sunk = 0.001;
  const Pose upper = makePose({0, 0, 2 * h - sunk}, {M_PI / 4, 0, 0}), lower = makePose({0, 0, 0}, {0, M_PI / 4, 0});
  const ContactManifold manifold = contactsOf(retractedCube(), upper, retractedCube(), lower);
  EXPECT_TRUE(manifold.pierced);
  ASSERT_EQ(countPierced(manifold), 1);
  EXPECT_NEAR(manifold.maxDepth(), SUM_OF_WIDTHS + sunk, 1e-12);
  for (const Contact& c : manifold.contacts) EXPECT_NEAR((c.normal_BA - Vector3::UnitZ()).norm(), 0, 1e-12);
}

TEST(Retraction, DepthIsContinuousThroughThePiercing) {
  geometry::RandomShapes random(31);
  const Collider hills = makeCollider(hillMesh(random, 0.5, 25, 0.002), SUM_OF_WIDTHS / 2), box = retractedCube(1);
  double before = -SUM_OF_WIDTHS;
  for (int step = 0; step < 400; ++step) {
    const double height = SIDE / 2 + 0.004 - 1e-5 * step;
    const ContactManifold manifold = contactsOf(box, makePose({0.013, 0.007, height}, {0.01, 0.02, 0.4}), hills, Pose::Identity());
    ASSERT_TRUE(allFinite(manifold));
    EXPECT_GE(manifold.maxDepth(), before - 1e-9) << step;
    before = manifold.maxDepth();
  }
  EXPECT_GT(before, SUM_OF_WIDTHS);
}

TEST(Retraction, SwappedPairIsMirrored) {
  geometry::RandomShapes random(32);
  int pierced = 0;
  for (int i = 0; i < 300; ++i) {
    const Collider a = retractedCube(), b = makeCollider(octahedronMesh(0.04), 0.001);
    const Pose X_WA = random.pose(0.06);
    const ContactManifold ab = contactsOf(a, X_WA, b, Pose::Identity());
    ContactManifold ba = contactsOf(b, Pose::Identity(), a, X_WA);
    for (Contact& contact : ba.contacts) contact.normal_BA = -contact.normal_BA;
    pierced += ab.pierced;
    EXPECT_EQ(ab.pierced, ba.pierced);
    EXPECT_EQ(ab.contacts.size(), ba.contacts.size());
    EXPECT_NEAR(largestDifference(ab.contacts, ba.contacts), 0, 1e-9);
  }
  EXPECT_GT(pierced, 100);
}

}  // namespace
}  // namespace blem_sim::contact
