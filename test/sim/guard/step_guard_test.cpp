#include "guard/step_guard.h"

#include <algorithm>
#include <memory>

#include "sim/found_contacts_of.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

TEST(Substeps, HalvesAtMostFourTimesAndEndsExactly) {
  Substeps substeps;
  EXPECT_EQ(substeps.fraction(), 1);
  while (substeps.canRedo()) substeps.redo(1);
  EXPECT_EQ(substeps.fraction(), 1.0 / 16);
  while (!substeps.finished()) substeps.accept();
  EXPECT_EQ(substeps.count(), 16);
  EXPECT_EQ(substeps.fractionDone(), 1);
}

TEST(Substeps, PlansWholeTicksOfWhatIsLeft) {
  Substeps substeps;
  substeps.plan(0.51);
  EXPECT_EQ(substeps.fraction(), 0.5);
  EXPECT_EQ(substeps.fractionAfter(), 0.5);
  substeps.accept();
  substeps.plan(1);
  EXPECT_EQ(substeps.fraction(), 0.5);
  substeps.plan(1e-9);
  EXPECT_EQ(substeps.fraction(), 1.0 / 16);
  substeps.accept();
  EXPECT_EQ(substeps.fractionLeft(), 7.0 / 16);
}

TEST(Substeps, CostOfAStepIsBoundedWhateverIsAskedFor) {
  Substeps substeps;
  int solves = 0;
  for (; !substeps.finished(); ++solves) {
    if (!substeps.isRedone()) substeps.plan(0.3);
    if (substeps.canRepeat()) {
      substeps.repeat();
      ++solves;
    } else if (substeps.canRedo()) {
      substeps.redo(1);
    } else {
      substeps.accept();
    }
    ASSERT_LE(solves, Substeps::MAX_SOLVES);
  }
  EXPECT_LE(substeps.count(), Substeps::MAX_SUBSTEPS);
  EXPECT_EQ(substeps.redone(), Substeps::MAX_REDONE + 2 * Substeps::MAX_REPEATED);
}

TEST(Substeps, APartIsRepeatedAsLongAsItIsAndOnce) {
  Substeps substeps;
  substeps.plan(0.5);
  substeps.repeat();
  EXPECT_TRUE(substeps.isRedone());
  EXPECT_FALSE(substeps.canRepeat());
  EXPECT_EQ(substeps.fraction(), 0.5);
  substeps.accept();
  EXPECT_FALSE(substeps.isRedone());
  EXPECT_TRUE(substeps.canRepeat());
}

TEST(Substeps, BoundByLinksInTensionAreEven) {
  Substeps substeps;
  substeps.bound(0.3);
  EXPECT_TRUE(substeps.isBeyondBound());
  substeps.redo(1);
  EXPECT_FALSE(substeps.isBeyondBound());
  for (; !substeps.finished(); substeps.accept()) {
    if (!substeps.isRedone()) substeps.plan(1);
    EXPECT_EQ(substeps.fraction(), 0.25);
    substeps.bound(0.3);
  }
  EXPECT_EQ(substeps.nextMost(), 4);
}

TEST(Substeps, GrowTwofoldOnceLinksTakeThemWithRoom) {
  Substeps tight(4), roomy(4), free(4);
  for (Substeps* substeps : {&tight, &roomy, &free}) EXPECT_EQ(substeps->fraction(), 0.25);
  tight.bound(0.6);
  roomy.bound(0.7);
  EXPECT_EQ(tight.nextMost(), 4);
  EXPECT_EQ(roomy.nextMost(), 8);
  EXPECT_EQ(free.nextMost(), 8);
  EXPECT_EQ(Substeps().nextMost(), Substeps::MAX_SUBSTEPS);
}

TEST(Substeps, OfOneTickAreBoundNoFurther) {
  Substeps substeps;
  substeps.bound(1e-9);
  while (substeps.canRedo()) substeps.redo(1);
  EXPECT_EQ(substeps.fraction(), 1.0 / 16);
  EXPECT_FALSE(substeps.isBeyondBound());
}

class UsesUpLayer : public testing::Test {
 protected:
  UsesUpLayer() : colliders_(2), before_(2), after_(2) {
    colliders_[0].body = 0;
    colliders_[1].body = 1;
  }

  /** Body 0 is A, above; the normal is +z. */
  static contact::ContactManifold manifold(double depth, bool pierced = false) {
    contact::ContactManifold m;
    m.a = 0;
    m.b = 1;
    m.layer = 0.01;
    m.pierced = pierced;
    contact::Contact contact;
    contact.point = Vector3::Zero();
    contact.normal_BA = Vector3::UnitZ();
    contact.depth = depth;
    m.contacts = {contact};
    return m;
  }

  bool check(const std::vector<contact::ContactManifold>& then, const std::vector<contact::ContactManifold>& now) {
    const bool unbounded = usesUpLayer(colliders_, then, now);
    std::vector<contact::Collider> bounded = colliders_;
    for (contact::Collider& collider : bounded) {
      collider.geometry = std::make_shared<const contact::CollisionGeometry>(
          std::make_shared<const geometry::TriangleMesh>(geometry::boxMesh(Vector3::Constant(0.1))));
      collider.radius = 0.005;
    }
    EXPECT_EQ(usesUpLayer(bounded, then, now), unbounded);
    return unbounded;
  }

  bool usesUpLayer(const std::vector<contact::Collider>& colliders, const std::vector<contact::ContactManifold>& then,
                   const std::vector<contact::ContactManifold>& now) {
    const FoundContacts start = foundContactsOf(then), end = foundContactsOf(now);
    const SolverContacts contacts;
    const std::vector<dynamics::JointDrive> drives;
    const dynamics::SolveResult result;
    const MadeSolve made{start, contacts, drives, result, before_, after_, 0.001};
    StepThreads threads(1);
    return sim::usesUpLayer(colliders, made, end, &threads);
  }

  std::vector<contact::Collider> colliders_;
  std::vector<dynamics::BodyState> before_, after_;
};

TEST_F(UsesUpLayer, AcceptsShallowAndSlow) {
  EXPECT_FALSE(check({}, {}));
  EXPECT_FALSE(check({manifold(-0.001)}, {manifold(0.0019)}));
  EXPECT_FALSE(check({manifold(0.007)}, {manifold(0.0089)}));
  EXPECT_FALSE(check({manifold(0.0091)}, {manifold(0.0095)}));
  EXPECT_FALSE(check({manifold(0.0099, true)}, {manifold(0.0105, true)}));
}

TEST_F(UsesUpLayer, RefusesDeepAndFast) {
  EXPECT_TRUE(check({manifold(0.008)}, {manifold(0.0092)}));
  EXPECT_TRUE(check({}, {manifold(0.0092)}));
  EXPECT_TRUE(check({manifold(0.0085)}, {manifold(0.005, true)}));
}

TEST_F(UsesUpLayer, RefusesLeaps) {
  EXPECT_TRUE(check({manifold(-0.001)}, {manifold(0.0021)}));
  EXPECT_TRUE(check({}, {manifold(0.0021)}));
  EXPECT_TRUE(check({manifold(0.003)}, {manifold(0.0051)}));
}

TEST_F(UsesUpLayer, RefusesWhatPassedThrough) {
  // 20 mm down, and on the other side nothing is near any more.
  after_[0].X_WB.translation().z() = -0.02;
  EXPECT_TRUE(check({manifold(-0.002)}, {}));
  // Motion sideways is no danger.
  after_[0].X_WB.translation() = Vector3(0.02, 0, 0);
  EXPECT_FALSE(check({manifold(-0.002)}, {}));
}

TEST_F(UsesUpLayer, IgnoresPairsWithoutLayer) {
  contact::ContactManifold bare = manifold(0.001, true);
  bare.layer = 0;
  EXPECT_FALSE(check({}, {bare}));
}

/** Height [m] of a cube 0.3 s after it was thrown at a single sheet. @param pierced whether a bare mesh ever was */
double thrownAtSheet(double speed, double tilt, bool* pierced) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.2})};
  config.objects[0].X_WO = makePose({0, 0, 0.2}, {tilt, 0.3 * tilt, 0});
  config.objects[0].linear_velocity = {0, 0, -speed};
  Simulator simulator(config, model::UriResolver());
  *pierced = false;
  for (int i = 0; i < 300; ++i) {
    const StepReport& report = simulator.step();
    *pierced = *pierced || (report.status & CONTACT_UNRELIABLE);
    EXPECT_LE(report.substeps, 16);
  }
  return bodyOf(simulator, "cube").X_WB.translation().z();
}

TEST(StepGuard, FastCubeDoesNotPassAThinSheet) {
  for (const double speed : {5.0, 20.0}) {
    for (const double tilt : {0.0, 0.7}) {
      bool pierced = false;
      EXPECT_GT(thrownAtSheet(speed, tilt, &pierced), 0.05) << speed << " m/s, tilt " << tilt;
      EXPECT_FALSE(pierced) << speed << " m/s, tilt " << tilt;
    }
  }
}

/** Most substeps of 60 ms of a cube above a sheet. */
int mostSubsteps(const Vector3& position, const Vector3& velocity, const Vector3& spin) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, position)};
  config.objects[0].linear_velocity = velocity;
  config.objects[0].angular_velocity = spin;
  Simulator simulator(config, model::UriResolver());
  int most = 1;
  for (int i = 0; i < 60; ++i) {
    const StepReport& report = simulator.step();
    most = std::max(most, report.substeps);
    EXPECT_EQ(report.redone_solves, 0);
    EXPECT_EQ((report.status & STEP_SHORTENED) != 0, report.substeps > 1);
  }
  return most;
}

TEST(StepGuard, OnlyWhatIsFastAndNearShortensTheStep) {
  const Vector3 zero = Vector3::Zero();
  EXPECT_EQ(mostSubsteps({0, 0, 0.0525}, zero, zero), 1);
  EXPECT_EQ(mostSubsteps({0, 0, 0.06}, {1.5, 0, -1.5}, zero), 1);
  EXPECT_EQ(mostSubsteps({0, 0, 0.5}, {20, 0, 0}, {0, 0, 100}), 1);
  EXPECT_EQ(mostSubsteps({0, 0, 0.2}, {0, 0, 20}, zero), 1);
  EXPECT_GT(mostSubsteps({0, 0, 0.2}, {0, 0, -10}, zero), 1);
  // On its way along the sheet the cube might meet features that no contact foresees.
  EXPECT_GT(mostSubsteps({0, 0, 0.0525}, {5, 0, 0}, zero), 1);
  EXPECT_GT(mostSubsteps({0, 0, 0.0525}, zero, {0, 0, 100}), 1);
}

TEST(StepGuard, ShortensBeforehandInsteadOfSolvingAgain) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, Vector3::Zero()), box("other", Vector3::Constant(0.1), 1, {1, 0, 0.0525})};
  config.objects[0].X_WO = makePose({0, 0, 0.15}, {0.7, 0.21, 0});
  config.objects[0].linear_velocity = {0, 0, -20};
  Simulator simulator(config, model::UriResolver());
  int substeps = 0;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(simulator.step().redone_solves, 0) << i;
    EXPECT_LT(simulator.report().max_of_layer, 0.1) << i;
    substeps = std::max(substeps, simulator.report().substeps);
  }
  EXPECT_GT(substeps, 4);
}

TEST(StepGuard, SoftLayerThatIsUsedUpShortensTheStep) {
  SimulationConfig config;
  config.environments = {ground()};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.06})};
  config.objects[0].linear_velocity = {0, 0, -5};
  for (ContactOverrides* contact : {&config.environments[0].contact, &config.objects[0].contact}) {
    contact->stiffness = 1e5;
    contact->damping = 50;
  }
  Simulator simulator(config, model::UriResolver());
  int most_substeps = 1;
  for (int i = 0; i < 10; ++i) {
    const StepReport& report = simulator.step();
    EXPECT_EQ((report.status & STEP_SHORTENED) != 0, report.substeps > 1);
    most_substeps = std::max(most_substeps, report.substeps);
  }
  EXPECT_GT(most_substeps, 1);
  EXPECT_LE(most_substeps, 16);
  EXPECT_DOUBLE_EQ(simulator.time(), 0.01);
}

}  // namespace
}  // namespace blem_sim::sim
