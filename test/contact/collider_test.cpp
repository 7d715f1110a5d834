#include "blem_sim/contact/collider.h"

#include <gtest/gtest.h>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/geometry/input_error.h"

namespace blem_sim::contact {
namespace {

TEST(CombineSurfaces, FrictionByEachRule) {
  SurfaceProperties a, b;
  a.friction = 0.2;
  b.friction = 0.6;
  EXPECT_DOUBLE_EQ(combineSurfaces(a, b, FrictionRule::MIN).friction, 0.2);
  EXPECT_DOUBLE_EQ(combineSurfaces(a, b, FrictionRule::MEAN).friction, 0.4);
  EXPECT_DOUBLE_EQ(combineSurfaces(a, b, FrictionRule::HARMONIC_MEAN).friction, 0.3);
  EXPECT_DOUBLE_EQ(combineSurfaces(a, b, FrictionRule::PRODUCT).friction, 0.12);
  a.friction = 0;
  EXPECT_DOUBLE_EQ(combineSurfaces(a, b, FrictionRule::HARMONIC_MEAN).friction, 0);
}

TEST(CombineSurfaces, LargerRestitutionSpringsInSeries) {
  SurfaceProperties a, b;
  a.restitution = 0.3;
  EXPECT_DOUBLE_EQ(combineSurfaces(a, b, FrictionRule::MIN).restitution, 0.3);
  EXPECT_TRUE(std::isinf(combineSurfaces(a, b, FrictionRule::MIN).stiffness));
  a.stiffness = 1000;
  EXPECT_DOUBLE_EQ(combineSurfaces(a, b, FrictionRule::MIN).stiffness, 1000);
  b.stiffness = 1000;
  EXPECT_DOUBLE_EQ(combineSurfaces(b, a, FrictionRule::MIN).stiffness, 500);
  b.damping = 0;
  EXPECT_DOUBLE_EQ(combineSurfaces(a, b, FrictionRule::MIN).damping, 0);
}

TEST(CombineSurfaces, SmallerImpactFrictionFactorWithItsSpeed) {
  SurfaceProperties a, b;
  a.impact_friction_factor = 0.8, a.impact_friction_speed = 0.1;
  for (const auto& pair : {combineSurfaces(a, b, FrictionRule::MIN), combineSurfaces(b, a, FrictionRule::MIN)}) {
    EXPECT_EQ(pair.impact_friction_factor, 0.8);
    EXPECT_EQ(pair.impact_friction_speed, 0.1);
  }
  b.impact_friction_factor = 0.8;
  EXPECT_EQ(combineSurfaces(a, b, FrictionRule::MIN).impact_friction_speed, 0);
}

TEST(CollisionGeometry, MeshAndHalfSpace) {
  const CollisionGeometry box(std::make_shared<geometry::TriangleMesh>(geometry::boxMesh({1, 2, 3})));
  EXPECT_FALSE(box.isHalfSpace());
  EXPECT_EQ(box.topology().edgeCount(), 18);
  EXPECT_FALSE(box.bvh().empty());
  EXPECT_TRUE(box.bounds().max().isApprox(Vector3(0.5, 1, 1.5)));
  const auto half_space = CollisionGeometry::halfSpace({0, 0, 2}, 0.1);
  EXPECT_TRUE(half_space->isHalfSpace());
  EXPECT_EQ(half_space->planeNormal(), Vector3::UnitZ());
  EXPECT_EQ(half_space->planeOffset(), 0.1);
}

TEST(CollisionGeometry, RefusesWhatCannotCollide) {
  EXPECT_THROW(CollisionGeometry(std::make_shared<geometry::TriangleMesh>()), InputError);
  EXPECT_THROW(CollisionGeometry(nullptr), InputError);
  EXPECT_THROW(CollisionGeometry::halfSpace(Vector3::Zero(), 0), InputError);
  EXPECT_THROW(CollisionGeometry::halfSpace({0, 0, NAN}, 0), InputError);
}

TEST(ContactManifold, DeepestOrNone) {
  ContactManifold manifold;
  EXPECT_EQ(manifold.maxDepth(), -std::numeric_limits<double>::infinity());
  manifold.contacts.resize(2);
  manifold.contacts[0].depth = -0.001;
  manifold.contacts[1].depth = -0.002;
  EXPECT_EQ(manifold.maxDepth(), -0.001);
}

}  // namespace
}  // namespace blem_sim::contact
