// Chains and spinning bodies that nothing drives, against theory, which keeps energy and momenta. The long ones are in test/soak.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/chains.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

const std::vector<ChainLink> TAPER = taper(6, {1, 0.3}, {0.02, 0.05});

/** Largest miss of energy, over that above rest. Energy swings by half a step of gravity's work, at any speed of the links. */
double energyMiss(const std::vector<ChainLink>& links, const ChainOptions& options, double seconds, double dt = DT, double viscous = 0) {
  Chain chain(links, options);
  for (JointDrive& drive : chain.drives) drive.viscous_friction = viscous;
  const double whole = chain.energyAboveRest(links);
  double worst = 0;
  for (int i = 0; i < static_cast<int>(std::lround(seconds / dt)); ++i) {
    if (!chain.step(dt).finite) return INFINITY;
    worst = std::max(worst, std::abs(chain.energy() - chain.first_energy) / whole);
  }
  EXPECT_EQ(chain.too_fast, 0);
  return worst;
}

TEST(FreeMotion, TaperedChainsKeepTheirEnergy) {
  EXPECT_LT(energyMiss(TAPER, {}, 5), 4e-3);
  EXPECT_LT(energyMiss(taper(6, {0.02, 0.05}, {1, 0.3}), {}, 5), 4e-3) << "light first";
  EXPECT_LT(energyMiss({{5, 0.3}, {2, 0.3}, {0.5, 0.3}, {0.05, 0.3}}, {}, 5), 4e-3);
}

TEST(FreeMotion, OfAnyTimeStep) {
  EXPECT_LT(energyMiss(TAPER, {}, 0.5, 1e-4), 4e-4);
  EXPECT_LT(energyMiss(TAPER, {}, 3, 2e-3), 8e-3);
  EXPECT_LT(energyMiss(TAPER, {}, 3, 5e-3), 0.02);
}

TEST(FreeMotion, UniversalJoints) {
  ChainOptions options;
  options.alternates = true;
  options.bend = 0.3;
  EXPECT_LT(energyMiss(TAPER, options, 5), 4e-3);
}

TEST(FreeMotion, FoldedChains) {
  ChainOptions options;
  options.fold = 2.8;
  EXPECT_LT(energyMiss(TAPER, options, 3), 4e-3);
  EXPECT_LT(energyMiss(taper(50, {0.1, 0.05}, {0.1, 0.05}), options, 0.8), 2e-3);
}

// Next to no friction is next to no loss: no other method takes over.
TEST(FreeMotion, NearlyFreeJoints) { EXPECT_LT(energyMiss(TAPER, {}, 5, DT, 1e-12), 0.01); }

/** Largest misses of energy, momentum and angular momentum, relative, without gravity. */
struct Kept {
  double energy = 0, momentum = 0, spin = 0;
};

Kept observe(Chain* chain, int steps, double dt) {
  chain->step(dt);  // the bodies' velocities are now those that the joints allow
  Kept kept;
  const double energy = chain->world.kineticEnergy();
  const Vector3 momentum = chain->momentum(), spin = chain->angularMomentum();
  for (int i = 0; i < steps; ++i) {
    EXPECT_TRUE(chain->step(dt).finite);
    kept.energy = std::max(kept.energy, std::abs(chain->world.kineticEnergy() / energy - 1));
    kept.momentum = std::max(kept.momentum, (chain->momentum() - momentum).norm() / momentum.norm());
    kept.spin = std::max(kept.spin, (chain->angularMomentum() - spin).norm() / spin.norm());
  }
  return kept;
}

TEST(FreeMotion, FreeChainKeepsItsMomenta) {
  ChainOptions options;
  options.held = false, options.alternates = true, options.fold = 0.5;
  options.gravity = Vector3::Zero();
  for (const double dt : {1e-4, 1e-3, 5e-3}) {
    Chain chain(TAPER, options);
    BodyState state = chain.world.bodyState(0);
    state.w_WB = {10, 30, 5};
    state.v_WCom = {1, 2, 0};
    chain.world.setBodyState(0, state);
    const Kept kept = observe(&chain, 1000, dt);
    EXPECT_LT(kept.energy, 1e-9) << dt;
    EXPECT_LT(kept.momentum, 1e-9) << dt;
    EXPECT_LT(kept.spin, 1e-8) << dt;
  }
}

// Steps so short that joints hardly turn in them, of two bars that turn about pins and have much energy for that.
TEST(FreeMotion, ShortStepsOfFastBarsMissLessThanAMicrojoule) {
  ChainOptions options;
  options.gravity = Vector3::Zero();
  Chain chain({{1, 0.3}, {1, 0.3}}, options);
  const Vector3 upper(0, 8, 0), lower(0, -7, 0), half(0.15, 0, 0);
  for (int link = 0; link < 2; ++link) {
    BodyState state = chain.world.bodyState(link);
    state.w_WB = link == 0 ? upper : lower;
    state.v_WCom = link == 0 ? upper.cross(half) : Vector3(2 * upper.cross(half) + lower.cross(half));
    chain.world.setBodyState(link, state);
  }
  for (const double dt : {6.6e-5, 3e-5, 1e-5}) {
    double worst = 0;
    for (int i = 0; i < 5000; ++i) {
      const double before = chain.world.kineticEnergy();
      chain.step(dt);
      worst = std::max(worst, std::abs(chain.world.kineticEnergy() - before));
    }
    EXPECT_LT(worst, 5e-7) << dt;
  }
  EXPECT_GT(chain.world.kineticEnergy(), 2);
}

// An arm that turns about a vertical axis, and a link that slides along it: angular momentum about the axis and energy stay. By
// both, the speed of the link along the arm is known.
TEST(FreeMotion, SliderInASpinningArm) {
  ChainOptions options;
  options.gravity = Vector3::Zero();
  options.slider = 1;
  const std::vector<ChainLink> links = {{1, 0.3}, {0.3, 0.1}};
  Chain chain(links, options);
  BodyState state = chain.world.bodyState(0);
  state.w_WB = {0, 100, 0};
  state.v_WCom = state.w_WB.cross(Vector3(0.15, 0, 0));
  chain.world.setBodyState(0, state);
  state.X_WB = chain.world.bodyState(1).X_WB;
  state.v_WCom = state.w_WB.cross(Vector3(0.35, 0, 0));
  chain.world.setBodyState(1, state);
  const double energy = chain.world.kineticEnergy(), spin = chain.angularMomentum().y();
  const double arm = 0.09 / 3, own = 0.3 * 0.01 / 12;
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(chain.step(DT).finite);
    const double q = chain.world.jointState(1).position, v = chain.world.jointState(1).velocity, r = 0.35 + q;
    ASSERT_NEAR(chain.world.kineticEnergy() / energy, 1, 1e-9);
    ASSERT_NEAR(chain.angularMomentum().y() / spin, 1, 1e-5);
    // 1/2 I(r) w^2 + 1/2 m v^2 with I w = L
    const double inertia = arm + own + 0.3 * r * r;
    ASSERT_NEAR(v, std::sqrt((2 * energy - spin * spin / inertia) / 0.3), 1e-3 * v) << i;
  }
}

class SpinningBody : public ::testing::TestWithParam<double> {};

// A body keeps spinning about its smallest and largest principal axes, about the middle one it turns over, and nothing is lost.
TEST_P(SpinningBody, KeepsItsEnergyAndItsAxis) {
  for (const double dt : {1e-4, 1e-3, 2e-3, 5e-3})
    for (int axis = 0; axis < 3; ++axis) {
      Spinner spinner(axis, GetParam());
      const double energy = spinner.world.kineticEnergy();
      const Vector3 momentum = spinner.momentum();
      double tilt = 0;
      for (int i = 0; i < 2000; ++i) {
        spinner.world.step(dt, {}, {});
        ASSERT_NEAR(spinner.world.kineticEnergy() / energy, 1, 1e-5) << axis;
        ASSERT_LT((spinner.momentum() - momentum).norm(), 1e-4 * momentum.norm()) << axis;
        const Vector3 spin = spinner.bodySpin();
        tilt = std::max(tilt, std::acos(std::min(1.0, std::abs(spin[axis]) / spin.norm())));
      }
      if (axis == 1)
        EXPECT_GT(tilt, 0.1) << dt;
      else
        EXPECT_LT(tilt, 5e-3) << dt;
    }
}
INSTANTIATE_TEST_SUITE_P(Speeds, SpinningBody, ::testing::Values(100, 300, 1000));

// Two links about a vertical axis, the outer one held at a right angle by its motor: centrifugal forces are its load, and the joint keeps
// its target.
TEST(FreeMotion, MotorCarriesCentrifugalForces) {
  for (const double stiffness : {1e4, 1e6}) {
    ChainOptions options;
    options.gravity = Vector3::Zero();
    options.bend = M_PI / 2;
    Chain chain({{1, 0.3}, {0.2, 0.1}}, options);
    chain.drives[1].stiffness = stiffness;
    chain.drives[1].target_position = M_PI / 2;
    constexpr double SPIN = 100;
    for (int body = 0; body < 2; ++body) {
      BodyState state = chain.world.bodyState(body);
      state.w_WB = {0, SPIN, 0};
      state.v_WCom = state.w_WB.cross(state.X_WB * chain.world.bodySpec(body).inertial.com);
      chain.world.setBodyState(body, state);
    }
    const double energy = chain.world.kineticEnergy();
    SolveResult result;
    Pose before = Pose::Identity();
    for (int i = 0; i < 1000; ++i) {
      before = chain.world.bodyState(0).X_WB;
      result = chain.step(DT);
      ASSERT_NEAR(chain.world.kineticEnergy() / energy, 1, 5e-3) << i;
    }
    // Force of the outer link's centre of mass towards the axis: m w^2 (0.3, 0.05) along and across the inner link.
    const double w = chain.world.bodyState(0).w_WB.y(), along = 0.2 * w * w * 0.3, across = 0.2 * w * w * 0.05;
    EXPECT_NEAR(result.axis_efforts[1] / (along * 0.05), 1, 1e-4) << stiffness;
    const Vector3 axes(-along, 0, across);
    const Vector3 force = before.linear() * Eigen::AngleAxisd(0.5 * w * DT, Vector3::UnitY()) * axes;
    EXPECT_LT((result.joint_wrenches[1].force - force).norm(), 2e-3 * force.norm()) << stiffness << "\n"
                                                                                    << result.joint_wrenches[1].force << "\n"
                                                                                    << force;
    EXPECT_NEAR(result.joint_wrenches[1].torque.y(), result.axis_efforts[1], 2e-3 * along * 0.05) << stiffness;
    EXPECT_LT(std::abs(chain.world.jointState(1).position - M_PI / 2), 2 * along * 0.05 / stiffness);
  }
}

// A chain that is too fast loses energy until it can be followed again, which a free one may never be, by its angular momentum.
TEST(FreeMotion, SaysWhatIsTooFast) {
  for (const bool held : {true, false}) {
    ChainOptions options;
    options.held = held, options.fold = 1;
    options.gravity = Vector3::Zero();
    Chain chain(TAPER, options);
    BodyState state = chain.world.bodyState(5);
    state.w_WB = {0, 3e6, 0};
    chain.world.setBodyState(5, state);
    EXPECT_TRUE(chain.step(DT).too_fast);
    for (int i = 0; i < 200; ++i) {
      const double before = chain.world.kineticEnergy();
      ASSERT_TRUE(chain.step(DT).finite);
      ASSERT_LE(chain.world.kineticEnergy(), before * (1 + 1e-9)) << i;
    }
    EXPECT_EQ(chain.step(DT).too_fast, !held);
  }
}

// Efforts by which one joint follows another do no work.
TEST(FreeMotion, OfJointsThatFollowEachOtherKeepsEnergyAndMomenta) {
  ChainOptions options;
  options.alternates = true, options.bend = 0.4, options.followers = {4};
  options.gravity = Vector3::Zero();
  for (const bool held : {false, true}) {
    options.held = held;
    for (const double spin : {5.0, 200.0, 5000.0}) {
      Chain chain(TAPER, options);
      BodyState state = chain.world.bodyState(5);
      state.w_WB = {0, spin, 0.3 * spin};
      chain.world.setBodyState(5, state);
      chain.step(DT);  // makes the velocities follow each other
      const Kept kept = observe(&chain, 1000, DT);
      EXPECT_LT(kept.energy, 1e-9) << spin;
      EXPECT_LT(held ? 0 : kept.momentum, 1e-9) << spin;
      EXPECT_LT(held ? 0 : kept.spin, 1e-9) << spin;
      const int follower = held ? 4 : 3;
      const JointState first = chain.world.jointState(0), last = chain.world.jointState(follower);
      EXPECT_NEAR(last.velocity, first.velocity, 1e-12 * spin);
      EXPECT_NEAR(last.position - first.position, chain.world.jointSpec(follower).mimic_offset, 1e-12);
      EXPECT_EQ(chain.too_fast, 0);
    }
  }
}

// The motor of one joint holds all that follow the same one with it, whichever the forest names first.
TEST(FreeMotion, OfJointsThatFollowAHeldOneKeepsTheirRelation) {
  ChainOptions options;
  options.alternates = true, options.bend = 0.4, options.followers = {2, 4};
  options.gravity = Vector3::Zero();
  for (const int driven : {2, 4}) {
    Chain chain(TAPER, options);
    chain.drives[driven].damping = 100;
    BodyState state = chain.world.bodyState(5);
    state.w_WB = {0, 1000, 300};
    chain.world.setBodyState(5, state);
    chain.step(DT);  // makes the velocities follow each other
    for (int i = 0; i < 100; ++i) {
      chain.step(DT);
      for (const int follower : options.followers)
        EXPECT_NEAR(chain.world.jointState(follower).velocity, chain.world.jointState(0).velocity, 1e-9) << i;
    }
    EXPECT_EQ(chain.too_fast, 0);
  }
}

/** Two free bars with a smaller one each, whose hinge follows that of the other two: no tree goes its way by itself. */
struct TiedBars {
  TiedBars() {
    JointSpec hinge;
    hinge.axis = Vector3(0, 1, 1).normalized();
    hinge.X_PJ = makePose({0.3, 0, 0});
    for (int pair = 0; pair < 2; ++pair) {
      BodySpec bar = rod({1, 0.3}), small = rod({0.1, 0.2});
      bar.X_WB = makePose({0, 1.0 * pair, 0});
      small.X_WB = bar.X_WB * hinge.X_PJ;
      hinge.parent = world.addBody(bar);
      hinge.child = world.addBody(small);
      if (pair == 1) hinge.mimic_joint = 0;
      world.addJoint(hinge, 0);
    }
  }
  bool step() { return world.step(DT, {}, drives).too_fast; }

  World world{Vector3::Zero(), {}};
  std::vector<JointDrive> drives{2};
};

// Trees that are tied are braked beyond their pace, and carry no momentum that their velocities do not have: such a one made 3 J to 500 in
// a step.
TEST(FreeMotion, OfTreesThatAreTiedIsBrakedBeyondItsPace) {
  for (const bool blow : {false, true}) {
    TiedBars bars;
    for (const int small : {1, 3}) {
      if (blow) {
        bars.world.applyWrench(small, {Vector3(0, 500, 300), Vector3(0, 3e4, 2e4)}, bars.world.bodyState(small).X_WB.translation());
      } else {
        BodyState state = bars.world.bodyState(small);
        state.w_WB = {300, 1000, 500};
        bars.world.setBodyState(small, state);
      }
    }
    EXPECT_TRUE(bars.step()) << "also by a blow in this step";
    const double first = bars.world.kineticEnergy();
    double most = 0;
    for (int i = 0; i < 1000; ++i) {
      bars.step();
      most = std::max(most, bars.world.kineticEnergy());
    }
    EXPECT_LE(most, 1.1 * first);
  }
}

// Held joints owe the impulses of their way: these are part of the state.
TEST(FreeMotion, ReplaysFromASavedState) {
  ChainOptions options;
  options.held = false, options.alternates = true, options.bend = 0.4;
  Chain chain(TAPER, options);
  for (std::size_t j = 0; j < chain.drives.size(); j += 2) chain.drives[j].stiffness = 1e4, chain.drives[j].target_position = 0.5;
  BodyState state = chain.world.bodyState(0);
  state.w_WB = {10, 60, 20};
  chain.world.setBodyState(0, state);
  for (int i = 0; i < 200; ++i) chain.step(DT);
  const WorldState saved = chain.world.save();
  for (int i = 0; i < 100; ++i) chain.step(DT);
  const WorldState once = chain.world.save();
  chain.world.restore(saved);
  for (int i = 0; i < 100; ++i) chain.step(DT);
  EXPECT_TRUE(chain.world.save() == once);
}

}  // namespace
}  // namespace blem_sim::dynamics
