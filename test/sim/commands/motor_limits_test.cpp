// Limits of velocity and effort, soft limits, modes and time-outs of motors on whole robots.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "blem_sim/geometry/input_error.h"
#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr double INERTIA = 0.02 + 2 * 0.25;  // [kg m^2] of the pendulum about its hinge

struct Limits {
  double velocity = 1e6, effort = 1e6;
  std::string extras;  ///< elements of the joint
};

SimulationConfig arm(const Limits& limits, MotorLaw law, const std::string& type = "continuous") {
  SimulationConfig config;
  std::string urdf = pendulumUrdf(limits.extras);
  urdf.replace(urdf.find("revolute"), 8, type);
  config.robots = {robot("pendulum", urdf, true)};
  config.robots[0].velocity_limits["hinge"] = limits.velocity;
  config.robots[0].effort_limits["hinge"] = limits.effort;
  config.robots[0].gains["default"] = {1000, 0, 60};
  config.robots[0].motor["default"] = law;
  return config;
}

struct Extremes {
  double velocity = 0, effort = 0;
};

Extremes extremesOf(Simulator* simulator, double seconds) {
  Extremes most;
  for (long i = std::lround(seconds / simulator->config().time_step); i > 0; --i) {
    const dynamics::JointState state = simulator->step().joints[0];
    most.velocity = std::max(most.velocity, std::abs(state.velocity));
    most.effort = std::max(most.effort, std::abs(state.effort));
  }
  return most;
}

class Motors : public ::testing::TestWithParam<std::tuple<MotorLaw, const char*>> {
 protected:
  MotorLaw law() const { return std::get<0>(GetParam()); }
  /** The iterative stepper misses rows by this, relative. */
  double tolerance() const { return std::string(std::get<1>(GetParam())) == "quick_step" ? 0.02 : 1e-6; }
  Simulator simulate(SimulationConfig config) const {
    config.solver.stepper = std::get<1>(GetParam());
    return Simulator(config, model::UriResolver());
  }
};

TEST_P(Motors, ObeyTheVelocityLimitOfTheUrdf) {
  for (const double limit : {0.1, 1.0}) {
    SimulationConfig config = arm({}, law());
    std::string& urdf = config.robots[0].urdf_xml;
    urdf.replace(urdf.find("velocity=\"10\""), 13, fmt::format("velocity=\"{}\"", limit));
    config.robots[0].velocity_limits.clear();
    Simulator simulator = simulate(config);
    simulator.commandJoints(0, {{"hinge"}, {-limit}, {}, {}});
    const Extremes most = extremesOf(&simulator, 0.5);
    EXPECT_LE(most.velocity, limit * (1 + tolerance()));
    EXPECT_NEAR(simulator.report().joints[0].velocity, -limit, 0.02 * limit) << "it uses the speed it has";
    stepFor(&simulator, 4);
    const dynamics::JointState end = simulator.report().joints[0];
    EXPECT_NEAR(1000 * (end.position + limit), 2 * 0.5 * G * std::cos(end.position), 10 * tolerance()) << "and arrives";
  }
}

TEST_P(Motors, ObeyIt) {
  // An effort, and a velocity beyond the limit.
  for (const bool effort : {true, false}) {
    SimulationConfig config = arm({2, 5, ""}, law());
    config.gravity = Vector3::Zero();
    Simulator simulator = simulate(config);
    const std::vector<double> none, large{50};
    simulator.commandJoints(0, {{"hinge"}, {}, effort ? none : large, effort ? large : none});
    const Extremes most = extremesOf(&simulator, 2);
    EXPECT_LE(most.velocity, 2 * (1 + tolerance()));
    EXPECT_LE(most.effort, 5 * (1 + 1e-9));
    EXPECT_NEAR(simulator.report().joints[0].velocity, 2, 1e-4 + tolerance());
    EXPECT_NEAR(simulator.report().joints[0].effort, 0, 0.1);
  }
}

TEST_P(Motors, HoldWithASmallVelocityLimitAsWithout) {
  Simulator slow = simulate(arm({1e-4, 1e6, ""}, law()));
  stepFor(&slow, 200 * slow.config().time_step);
  // The sag is reached at that speed, not left at it.
  const double sag = slow.report().joints[0].position;
  stepFor(&slow, 2);
  EXPECT_LE(slow.report().joints[0].position, 2 * 0.5 * G / 1000 * (1 + 5 * tolerance()) + 1e-5);
  EXPECT_GE(slow.report().joints[0].position, sag);
}

// Gravity is no motor: what falls may be faster.
TEST_P(Motors, LimitNothingButThemselves) {
  Simulator simulator = simulate(arm({0.5, 1e6, ""}, law()));
  simulator.commandJoints(0, {{"hinge"}, {}, {}, {0}});
  stepFor(&simulator, 0.3);
  EXPECT_GT(simulator.report().joints[0].velocity, 3);
}

TEST_P(Motors, KeepAnEffortAlone) {
  SimulationConfig config = arm({}, law());
  config.gravity = Vector3::Zero();
  Simulator simulator = simulate(config);
  simulator.commandJoints(0, {{"hinge"}, {}, {}, {0.52}});
  stepFor(&simulator, 1);
  EXPECT_NEAR(simulator.report().joints[0].velocity, 1, 1e-5) << "no gains against it";
  simulator.commandJoints(0, {{"hinge"}, {2}, {}, {}});
  stepFor(&simulator, 3);
  EXPECT_NEAR(simulator.report().joints[0].position, 2, 1e-6) << "and it ends with the mode";
}

TEST_P(Motors, HoldWhenCommandsStop) {
  for (const bool effort : {true, false}) {
    SimulationConfig config = arm({}, law());
    config.gravity = Vector3::Zero();
    config.robots[0].command_timeout = 0.5;
    Simulator simulator = simulate(config);
    const std::vector<double> none, one{1};
    const JointCommandMessage command{{"hinge"}, {}, effort ? none : one, effort ? one : none};
    for (int i = 0; i < 3; ++i) {
      simulator.commandJoints(0, command);
      stepFor(&simulator, 0.4);
      EXPECT_GT(simulator.report().joints[0].velocity, 0.3);
    }
    stepFor(&simulator, 0.101);
    const double held = simulator.desiredState(0, 0).position;
    EXPECT_NEAR(simulator.report().joints[0].position, held, 0.01);
    stepFor(&simulator, 3);
    EXPECT_NEAR(simulator.report().joints[0].position, held, 1e-6);
    EXPECT_NEAR(simulator.report().joints[0].velocity, 0, 1e-6);
  }
}

// d v / d t = k_position (soft limit - q): the way that is left falls exponentially.
TEST_P(Motors, SlowDownBeforeSoftLimits) {
  const std::string safety = R"(<safety_controller soft_lower_limit="-1" soft_upper_limit="1" k_position="5" k_velocity="0"/>)";
  SimulationConfig config = arm({2, 1e6, safety}, law(), "revolute");
  config.gravity = Vector3::Zero();
  Simulator simulator = simulate(config);
  simulator.commandJoints(0, {{"hinge"}, {}, {}, {20}});
  stepFor(&simulator, 1);
  const double left = 1 - simulator.report().joints[0].position;
  stepFor(&simulator, 0.5);
  EXPECT_NEAR(1 - simulator.report().joints[0].position, left * std::exp(-5 * 0.5), 0.02 * left);
  stepFor(&simulator, 5);
  EXPECT_NEAR(simulator.report().joints[0].position, 1, 1e-5);
  EXPECT_FALSE(simulator.report().status & JOINT_LIMIT_HIT);
}

TEST_P(Motors, EffortEndsWithTheVelocityThatIsLeft) {
  const std::string safety = R"(<dynamics damping="2"/><safety_controller k_velocity="3"/>)";
  SimulationConfig config = arm({2, 1e6, safety}, law());
  config.gravity = Vector3::Zero();
  Simulator simulator = simulate(config);
  simulator.commandJoints(0, {{"hinge"}, {}, {}, {100}});
  stepFor(&simulator, 5);
  // 3 (2 - v) = 2 v.
  EXPECT_NEAR(simulator.report().joints[0].velocity, 1.2, 1e-6);
}

/** A link of 20 g and 5 cm. */
SimulationConfig lightArm(double stiffness) {
  SimulationConfig config;
  config.robots = {robot("light", R"(<robot name="light"><link name="base"/><link name="finger">
    <inertial><origin xyz="0.025 0 0"/><mass value="0.02"/><inertia ixx="1e-6" iyy="4e-6" izz="4e-6" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="hinge" type="revolute"><parent link="base"/><child link="finger"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="0.5" velocity="2"/></joint></robot>)",
                         true)};
  config.robots[0].gains["default"] = {stiffness, 0, 0.02 * stiffness};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  return config;
}

class LightLink : public ::testing::TestWithParam<const char*> {};

TEST_P(LightLink, ImplicitGainsAreStable) {
  const bool exact = std::string(GetParam()) == "articulated";
  for (double stiffness = 0.1; stiffness < 2e6; stiffness *= 10) {
    for (const double effort : {0.5, 1e5}) {
      SimulationConfig config = lightArm(stiffness);
      config.solver.stepper = GetParam();
      config.robots[0].effort_limits["hinge"] = effort;
      // ODE's steppers, whose motors have one row, know a step late that a load drives the joint on.
      if (!exact) config.gravity = Vector3::Zero();
      Simulator simulator(config, model::UriResolver());
      simulator.commandJoints(0, {{"hinge"}, {1}, {}, {}});
      const Extremes most = extremesOf(&simulator, 2);
      EXPECT_LE(most.velocity, 2 + (exact ? 1e-6 : 0.04)) << stiffness;
      EXPECT_LE(most.effort, effort * (1 + 1e-9)) << stiffness;
      if (stiffness < 1) continue;
      const double sag = 0.02 * config.gravity.norm() * 0.025 * std::cos(1) / stiffness;
      EXPECT_NEAR(simulator.report().joints[0].position, 1 + sag, 0.1 * sag + 1e-5) << stiffness;
      EXPECT_NEAR(simulator.report().joints[0].velocity, 0, 1e-5) << stiffness;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Steppers, LightLink, ::testing::Values("articulated", "world_step", "quick_step"),
                         [](const auto& info) { return std::string(info.param); });

INSTANTIATE_TEST_SUITE_P(Laws, Motors,
                         ::testing::Combine(::testing::Values(MotorLaw::PID, MotorLaw::IMPLICIT_PD),
                                            ::testing::Values("articulated", "world_step", "quick_step")),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param) == MotorLaw::PID ? "pid_" : "implicit_") + std::get<1>(info.param);
                         });

// Without motion of the target: the frequency of p alone, and the answer of p and d to a step.
TEST(MotorLaws, PeriodAndStepResponseAreTheClosedForms) {
  constexpr int PERIODS = SANITIZED ? 1 : 5;
  for (const MotorLaw law : {MotorLaw::PID, MotorLaw::IMPLICIT_PD}) {
    SimulationConfig config = arm({}, law);
    config.gravity = Vector3::Zero();
    config.time_step = 1e-4;
    config.robots[0].gains["default"] = {20, 0, 0};
    config.robots[0].initial_positions["hinge"] = 0;
    Simulator swings(config, model::UriResolver());
    swings.commandJoints(0, {{"hinge"}, {0.1}, {}, {}});
    std::vector<double> crossings;  // of the target, upwards
    for (double last = 0; crossings.size() <= PERIODS;) {
      const double q = swings.step().joints[0].position - 0.1;
      if (last < 0 && q >= 0) crossings.push_back(swings.time() - config.time_step * q / (q - last));
      last = q;
    }
    const double period = 2 * M_PI * std::sqrt(INERTIA / 20);
    EXPECT_NEAR((crossings.back() - crossings.front()) / PERIODS, period, 1e-4 * period);

    const double w = std::sqrt(20 / INERTIA), zeta = 0.3, damped = w * std::sqrt(1 - zeta * zeta);
    config.robots[0].gains["default"] = {20, 0, 2 * zeta * w * INERTIA};
    Simulator steps(config, model::UriResolver());
    steps.commandJoints(0, {{"hinge"}, {0.5}, {}, {}});
    while (steps.time() < (SANITIZED ? 0.5 : 2)) {
      const double q = steps.step().joints[0].position, t = steps.time();
      const double form = 1 - std::exp(-zeta * w * t) * (std::cos(damped * t) + zeta * w / damped * std::sin(damped * t));
      ASSERT_NEAR(q, 0.5 * form, 0.01 * 0.5) << t;
    }
  }
}

TEST(MotorLaws, StickAndSlipAtDryFriction) {
  for (const double share : {0.99, 1.01}) {
    SimulationConfig config = arm({}, MotorLaw::IMPLICIT_PD);
    config.gravity = Vector3::Zero();
    config.robots[0].joint_friction["hinge"] = {3, 0};
    Simulator simulator(config, model::UriResolver());
    simulator.commandJoints(0, {{"hinge"}, {}, {}, {share * 3}});
    stepFor(&simulator, 10);
    const dynamics::JointState state = simulator.report().joints[0];
    if (share < 1)
      EXPECT_LT(std::abs(state.position), 1e-9);
    else
      EXPECT_NEAR(state.velocity, 0.01 * 3 / INERTIA * 10, 1e-3 * 0.03 / INERTIA * 10);
  }
}

// Gravity pulls with 9.8 N m; the integral takes the error down to what friction holds against p, 3 mrad, and then rests.
TEST(MotorLaws, IntegralRestsWithinDryFriction) {
  for (const MotorLaw law : {MotorLaw::PID, MotorLaw::IMPLICIT_PD}) {
    SimulationConfig config = arm({}, law);
    config.robots[0].gains["default"] = {1000, 500, 60};
    config.robots[0].joint_friction["hinge"] = {3, 0};
    Simulator simulator(config, model::UriResolver());
    stepFor(&simulator, 10);
    const double position = simulator.report().joints[0].position;
    EXPECT_NEAR(position, 3e-3, 1e-4);
    stepFor(&simulator, 20);
    EXPECT_NEAR(simulator.report().joints[0].position, position, 1e-9);
  }
}

TEST(MotorLaws, ArmatureIsRefusedWhereItIsNotKnown) {
  for (const char* stepper : {"world_step", "quick_step"}) {
    SimulationConfig config = arm({}, MotorLaw::IMPLICIT_PD);
    config.solver.stepper = stepper;
    config.robots[0].armature["hinge"] = 0.1;
    try {
      Simulator simulator(config, model::UriResolver());
      ADD_FAILURE() << stepper << " takes it silently";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("robots: pendulum: armature: hinge: " + std::string(stepper)), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace blem_sim::sim
