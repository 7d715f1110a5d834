// Trees that tumble or swing while their motors work against contacts, against theory: a motor that moves nothing does no work.
#include <gtest/gtest.h>

#include <iterator>
#include <vector>

#include "support/chains.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

/** Two links without gravity, the second across the first, whose motor presses it against a stop on the first: one rigid body, in theory.
 */
class PressedElbow {
 public:
  /** @param held the first link turns about the origin; else all of it flies @param spin [rad/s] of all of it about the origin */
  PressedElbow(bool held, const Vector3& spin) : chain({{1, 0.3}, {0.5, 0.2}}, options(held)) {
    chain.drives.back().effort = EFFORT;
    for (int body = 0; body < 2; ++body) {
      BodyState state = chain.world.bodyState(body);
      state.w_WB = spin;
      state.v_WCom = spin.cross(state.X_WB * chain.world.bodySpec(body).inertial.com);
      chain.world.setBodyState(body, state);
    }
    first_energy = chain.world.kineticEnergy();
    first_spin = chain.angularMomentum();
  }

  /** Steps on, and expects the stop to hold and the joints' wrenches to be those of their laws. */
  void step() {
    const Pose X_WB = chain.world.bodyState(0).X_WB;
    ContactConstraint stop;
    stop.body_a = 1;
    stop.body_b = 0;
    stop.point = X_WB * Vector3(0.3, 0, -ARM);
    stop.normal_BA = X_WB.linear().col(0);
    stop.depth = ARM * (elbow() - M_PI / 2);
    const SolveResult& result = chain.world.step(DT, {stop}, chain.drives);
    EXPECT_GT(stop.normal_BA.dot(result.contact_forces[0]), 0);
    EXPECT_NEAR(elbow(), M_PI / 2, 1e-3);
    const double along_axis = result.joint_wrenches.back().torque.dot(X_WB.linear().col(1));
    EXPECT_NEAR(along_axis, result.axis_efforts.back(), 1e-5 * EFFORT);
  }

  double elbow() const { return chain.world.jointState(chain.world.jointCount() - 1).position; }

  Chain chain;
  double first_energy;
  Vector3 first_spin;

 private:
  static constexpr double EFFORT = 20, ARM = 0.05;  // [N m] more than what turning asks for; [m] from the elbow to the stop
  static ChainOptions options(bool held) {
    ChainOptions options;
    options.held = held;
    options.bend = M_PI / 2;
    options.gravity = Vector3::Zero();
    return options;
  }
};

TEST(WorkingMotion, KeepsItsEnergyAndMomentaInFlight) {
  for (const Vector3& spin : {Vector3(0, 7, 0), Vector3(3, 7, 2), Vector3(0, 0, 20)}) {
    PressedElbow flies(false, spin);
    for (int i = 0; i < 1000 && !HasFailure(); ++i) flies.step();
    EXPECT_NEAR(flies.chain.world.kineticEnergy() / flies.first_energy, 1, 1e-4) << spin.transpose();
    EXPECT_LT((flies.chain.angularMomentum() - flies.first_spin).norm(), 1e-6 * flies.first_spin.norm()) << spin.transpose();
  }
}

TEST(WorkingMotion, KeepsItsEnergyOnABearing) {
  PressedElbow turns(true, {0, 10, 0});
  for (int i = 0; i < 1000 && !HasFailure(); ++i) turns.step();
  EXPECT_NEAR(turns.chain.world.kineticEnergy() / turns.first_energy, 1, 1e-4);
}

/** Lengths [ms] of steps that follow each other. */
constexpr double UNEVEN_STEPS[] = {1, 1, 0.5, 0.5, 1, 0.25, 0.25, 0.5};

double unevenStep(int i) { return 1e-3 * UNEVEN_STEPS[i % std::size(UNEVEN_STEPS)]; }

/** Makes a step. @return [N] by how much the last joint's force is not what moves the last link, which nothing else touches */
double missOfNewton(Chain* chain, double dt) {
  const int link = chain->world.bodyCount() - 1;
  const Vector3 before = chain->world.bodyState(link).v_WCom;
  const SolveResult& result = chain->step(dt);
  const Vector3 needed = chain->world.bodySpec(link).inertial.mass / dt * (chain->world.bodyState(link).v_WCom - before);
  return (result.joint_wrenches.back().force - needed).norm();
}

// Three links whose motors press them against the limits of their joints: one rigid body as well.
TEST(WorkingMotion, LimitsHoldInFlightWhatPressesAgainstThem) {
  for (const bool even : {true, false}) {
    ChainOptions options;
    options.held = false;
    options.bend = 1.2;
    options.gravity = Vector3::Zero();
    Chain chain({{1, 0.3}, {0.5, 0.2}, {0.05, 0.1}}, options);
    const int joints = chain.world.jointCount();
    std::vector<double> stops;
    for (int j = 0; j < joints; ++j) {
      stops.push_back(chain.world.jointState(j).position);
      chain.world.setJointLimits(j, -3, stops.back());
      chain.drives[j].effort = 20;
    }
    const Vector3 spin(6, 2, 20);
    for (int body = 0; body < chain.world.bodyCount(); ++body) {
      BodyState state = chain.world.bodyState(body);
      state.w_WB = spin;
      state.v_WCom = spin.cross(state.X_WB * chain.world.bodySpec(body).inertial.com);
      chain.world.setBodyState(body, state);
    }
    const double energy = chain.world.kineticEnergy();
    const Vector3 momentum = chain.angularMomentum();
    for (int i = 0; i < 1000; ++i) {
      ASSERT_LT(missOfNewton(&chain, even ? DT : unevenStep(i)), 1e-5) << i;
      for (int j = 0; j < joints; ++j) {
        ASSERT_NEAR(chain.world.jointState(j).position, stops[j], 1e-6) << i;
        ASSERT_NEAR(chain.world.jointState(j).velocity, 0, 1e-5) << i;
      }
    }
    EXPECT_NEAR(chain.world.kineticEnergy() / energy, 1, 1e-4);
    EXPECT_LT((chain.angularMomentum() - momentum).norm(), 1e-6 * momentum.norm());
  }
}

// A link that slides along a spinning arm rests against its outer stop, which bears m w^2 r whatever the steps' lengths.
TEST(WorkingMotion, StopOfASliderBearsTheCentrifugalForce) {
  ChainOptions options;
  options.gravity = Vector3::Zero();
  options.slider = 1;
  Chain chain({{1, 0.3}, {0.3, 0.1}}, options);
  chain.world.setJointLimits(1, -0.1, 0);
  constexpr double SPIN = 30;
  for (int body = 0; body < 2; ++body) {
    BodyState state = chain.world.bodyState(body);
    state.w_WB = {0, SPIN, 0};
    state.v_WCom = state.w_WB.cross(state.X_WB * chain.world.bodySpec(body).inertial.com);
    chain.world.setBodyState(body, state);
  }
  for (int i = 0; i < 1000; ++i) {
    const double dt = unevenStep(i);
    const Pose X_WA = chain.world.bodyState(0).X_WB;
    const SolveResult& result = chain.step(dt);
    const Vector3 outwards = X_WA.linear() * Eigen::AngleAxisd(0.5 * SPIN * dt, Vector3::UnitY()) * Vector3::UnitX();
    const double w = chain.world.bodyState(0).w_WB.y();
    if (i < 50) continue;  // in the first step the stop does not push yet: the link slides on by 0.2 mm
    ASSERT_NEAR(-outwards.dot(result.joint_wrenches[1].force) / (0.3 * w * w * 0.35), 1, 1e-3) << i;
    ASSERT_NEAR(chain.world.jointState(1).position, 0, 1e-5) << i;
  }
}

constexpr double SLIDER_ARM = 0.35;  // [m] from the pivot of an ArmWithSlider to the slider's centre of mass at its stop

/** An arm that spins about its end, and on it a slider of 0.3 kg, `room` off the stop on its inner side. */
struct ArmWithSlider : Chain {
  ArmWithSlider(double spin, double room, double inwards) : Chain({{1, 0.3}, {0.3, 0.1}}, options()) {
    world.setJointLimits(1, -room, 10);
    for (int body = 0; body < 2; ++body) {
      BodyState state = world.bodyState(body);
      state.w_WB = {0, spin, 0};
      state.v_WCom = state.w_WB.cross(state.X_WB * world.bodySpec(body).inertial.com) - body * inwards * Vector3::UnitX();
      world.setBodyState(body, state);
    }
    first_energy = world.kineticEnergy();
  }
  static ChainOptions options() {
    ChainOptions options;
    options.gravity = Vector3::Zero();
    options.slider = 1;
    return options;
  }
};

// A spring and a damper hold the slider against the centrifugal force: k x = m w^2 (r + x), however strong the damper.
TEST(WorkingMotion, DampersTakeNothingFromASpringThatWhirlsRound) {
  constexpr double SPIN = 20, SPRING = 1000;
  const double pull = 0.3 * SPIN * SPIN, theory = pull * SLIDER_ARM / (SPRING - pull);
  for (const double time_step : {1e-3, 4e-3}) {
    for (const double share : {0.03, 0.3}) {  // of the slider's mass, by which the damper answers in a step
      for (const bool is_motors : {true, false}) {
        ArmWithSlider chain(SPIN, 0.1, 0);
        chain.drives[0].target_velocity = SPIN;
        chain.drives[0].damping = 1e5;
        chain.drives[1].stiffness = SPRING;
        (is_motors ? chain.drives[1].damping : chain.drives[1].viscous_friction) = share * 0.3 / time_step;
        for (int i = 0; i < 4 / time_step; ++i) chain.step(time_step);
        EXPECT_NEAR(chain.world.jointState(1).position, theory, 1e-3 * theory) << time_step << " " << share << " " << is_motors;
      }
    }
  }
}

// What stopped the slider in one step presses on nothing in the next, where it would push the slider off.
TEST(WorkingMotion, StopThatWasHitDoesNotPushOff) {
  for (const double spin : {5, 20, 40}) {
    for (const double inwards : {3, 30}) {
      ArmWithSlider chain(spin, 0.02, inwards);
      double energy = chain.world.kineticEnergy();
      for (int i = 0; i < 100; ++i) {
        chain.step(DT);
        ASSERT_LT(chain.world.kineticEnergy() - energy, 1e-10) << spin << ", " << inwards << ", " << i;
        energy = chain.world.kineticEnergy();
      }
    }
  }
}

// An effort that is little more than the centrifugal force keeps the slider on its inner stop.
TEST(WorkingMotion, StopGivesWayToAllThatPressesOnIt) {
  constexpr double SPIN = 30;
  for (const double share : {0.2, 0.55, 0.75, 0.95}) {
    ArmWithSlider chain(SPIN, 0, 0);
    chain.drives[1].effort = -0.3 * SPIN * SPIN * SLIDER_ARM / share;
    for (int i = 0; i < 500; ++i) {
      chain.step(DT);
      ASSERT_NEAR(chain.world.jointState(1).position, 0, 1e-9) << share << ", " << i;
    }
    EXPECT_NEAR(chain.world.kineticEnergy() / chain.first_energy, 1, 1e-9) << share;
  }
}

// A limp chain that spins about its end: what stops its last hinge stops the first one, which that one follows.
TEST(WorkingMotion, StopsOfJointsThatFollowOthersDoNotPushOff) {
  for (const bool alternates : {false, true}) {
    for (const double bend : {0.2, -0.4}) {
      ChainOptions options;
      options.gravity = Vector3::Zero();
      options.alternates = alternates;
      options.bend = bend;
      options.followers = {3};
      Chain chain({{0.5, 0.2}, {0.4, 0.2}, {0.5, 0.3}, {0.2, 0.2}}, options);
      chain.world.setJointLimits(3, -3, chain.world.jointState(3).position + 0.05);
      for (int body = 0; body < 4; ++body) {
        BodyState state = chain.world.bodyState(body);
        state.w_WB = {0, 40, 0};
        state.v_WCom = state.w_WB.cross(state.X_WB * chain.world.bodySpec(body).inertial.com);
        chain.world.setBodyState(body, state);
      }
      const double first = chain.world.kineticEnergy();
      double energy = INFINITY;  // the first step makes velocities that mimic joints can have
      for (int i = 0; i < 300; ++i) {
        chain.step(DT);
        ASSERT_LT(chain.world.kineticEnergy() - energy, 5e-6 * first) << alternates << ", " << bend << ", " << i;
        energy = chain.world.kineticEnergy();
      }
    }
  }
}

}  // namespace
}  // namespace blem_sim::dynamics
