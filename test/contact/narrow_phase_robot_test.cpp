// A real foot (CAD triangles, needles and all) on a plane and on terrain.
#include <gtest/gtest.h>

#include "blem_sim/geometry/closest_points.h"
#include "contact/contact_shapes.h"
#include "contact/stl_soup.h"
#include "support/shared_data.h"

namespace blem_sim::contact {
namespace {

constexpr const char* FOOT = "robots/klampt/huboplus/meshes/Body_LAR_col_simple.stl";

class HuboFoot : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_SHARED_DATA(FOOT);
    const geometry::TriangleMesh mesh = geometry::cleanMesh(readStlSoup(*sharedData(FOOT)), nullptr);
    lowest_ = mesh.bounds().min().z();
    foot_ = makeCollider(mesh, 0.0025);
  }

  double lowest_ = 0;
  Collider foot_;
};

TEST_F(HuboFoot, OnPlanesOfAnyTessellation) {
  for (const int cells : {1, 50}) {
    const Pose X_WA = makePose({0.013, 0.021, 0.002 - lowest_}, {0, 0, 0.3});
    const ContactManifold manifold = contactsOf(foot_, X_WA, makeCollider(geometry::gridMesh(1, 1, cells, cells), 0), Pose::Identity());
    EXPECT_FALSE(manifold.pierced);
    ASSERT_GE(manifold.contacts.size(), 3u);
    EXPECT_NEAR(manifold.maxDepth(), 0.0005, 1e-9);
    for (const Contact& c : manifold.contacts) EXPECT_NEAR((c.normal_BA - Vector3::UnitZ()).norm(), 0, 1e-9);
  }
}

TEST_F(HuboFoot, FarFromTheWorldsOriginAsNear) {
  geometry::RandomShapes random(41);
  const Collider hills = makeCollider(hillMesh(random, 1, 100, 0.002), 0);
  const Pose X_WA = makePose({0.013, 0.021, 0.003 - lowest_}, {0.004, 0.01, 0.3});
  const ContactManifold near = contactsOf(foot_, X_WA, hills, Pose::Identity());
  const Pose far = makePose({1000, -2000, 500}, {0.3, 0.2, 0.1});
  ContactManifold there = contactsOf(foot_, far * X_WA, hills, far);
  ASSERT_GT(near.contacts.size(), 10u);
  EXPECT_EQ(near.contacts.size(), there.contacts.size());
  for (Contact& c : there.contacts) {
    c.point = far.inverse() * c.point;
    c.normal_BA = far.linear().transpose() * c.normal_BA;
  }
  EXPECT_LT(largestDifference(near.contacts, there.contacts), 1e-8);
}

TEST_F(HuboFoot, CompleteOnTerrain) {
  geometry::RandomShapes random(42);
  const Collider hills = makeCollider(hillMesh(random, 0.4, 8, 0.01), 0);
  int within = 0;
  for (int i = 0; i < 30; ++i) {
    Pose X_WA = makePose({random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), 0.1 - lowest_}, random.point(0.2));
    geometry::ClosestPoints exact = geometry::closestMeshMeshBruteForce(foot_.geometry->mesh(), hills.geometry->mesh(), X_WA);
    X_WA.pretranslate((exact.point_b - exact.point_a) * (1 - 0.001 / exact.distance));
    exact = geometry::closestMeshMeshBruteForce(foot_.geometry->mesh(), hills.geometry->mesh(), X_WA);
    const ContactManifold manifold = contactsOf(foot_, X_WA, hills, Pose::Identity());
    ASSERT_TRUE(allFinite(manifold));
    if (exact.distance == 0) continue;
    ++within;
    EXPECT_FALSE(manifold.pierced);
    EXPECT_NEAR(manifold.layer - manifold.maxDepth(), exact.distance, 1e-8);
  }
  EXPECT_GT(within, 20);
}

}  // namespace
}  // namespace blem_sim::contact
