#include "commands/joint_motor.h"

#include <cmath>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double STEP = 0.001;

MotorSettings settings(MotorLaw law, const JointGains& gains, double limit = std::numeric_limits<double>::infinity()) {
  MotorSettings settings;
  settings.gains = gains;
  settings.law = law;
  settings.effort_limit = limit;
  settings.commanded = true;
  return settings;
}

TEST(JointMotor, Equation7) {
  JointMotor motor(settings(MotorLaw::PID, {100, 20, 3}), 0.5);
  motor.sample(0, STEP);
  const dynamics::JointDrive drive = motor.drive({0.3, -0.2, 0});
  EXPECT_DOUBLE_EQ(drive.effort, 100 * 0.2 + 3 * 0.2);
  EXPECT_EQ(drive.stiffness, 0);
  EXPECT_FALSE(motor.accept(drive, {0.3, 0, 0}, STEP));
  motor.sample(STEP, STEP);
  EXPECT_DOUBLE_EQ(motor.drive({0.5, 0, 0}).effort, 20 * 0.2 * STEP);
}

TEST(JointMotor, IntegralTermIsClamped) {
  JointMotor motor(settings(MotorLaw::PID, {0, 1000, 0, 0.05}), 1);
  for (int i = 0; i < 10; ++i) {
    motor.sample(i * STEP, STEP);
    motor.accept(motor.drive({0, 0, 0}), {}, STEP);
  }
  motor.sample(0.01, STEP);
  EXPECT_DOUBLE_EQ(motor.drive({0, 0, 0}).effort, 0.05);
}

/** A hand that has grasped for seconds opens at once. */
TEST(JointMotor, IntegralDoesNotWindUpWhileSaturated) {
  for (const MotorLaw law : {MotorLaw::PID, MotorLaw::IMPLICIT_PD}) {
    JointMotor motor(settings(law, {100, 1000, 1}, 30), 1);  // 0 is where it is held
    for (int i = 0; i < 5000; ++i) {
      motor.sample(i * STEP, STEP);
      EXPECT_TRUE(motor.accept(motor.drive({0, 0, 0}), {0, 0, 0}, STEP));
    }
    // 100 N m/rad ask for 100; the integral holds nothing but its gain of the first steps.
    motor.hold(-0.1, 0);
    motor.sample(5, STEP);
    const dynamics::JointDrive drive = motor.drive({0, 0, 0});
    const double asked = law == MotorLaw::PID ? drive.effort : drive.stiffness * drive.target_position;
    EXPECT_NEAR(asked, -10, 1.1);
  }
}

TEST(JointMotor, EffortIsCappedAndSaid) {
  JointMotor motor(settings(MotorLaw::PID, {1000, 0, 0}, 30), 1);
  motor.sample(0, STEP);
  const dynamics::JointDrive drive = motor.drive({0, 0, 0});
  EXPECT_EQ(drive.effort, 30);
  EXPECT_TRUE(motor.accept(drive, {0, 0, 0}, STEP));
  motor.sample(0, STEP);
  EXPECT_EQ(motor.drive({3, 0, 0}).effort, -30);
}

TEST(JointMotor, ImplicitLawBoundsTheSumOfFeedbackAndFeedForward) {
  JointMotor motor(settings(MotorLaw::IMPLICIT_PD, {100, 0, 2}, 30), 0.1);
  motor.addEffort(5);
  motor.sample(0, STEP);
  const dynamics::JointDrive drive = motor.drive({0, 0, 0});
  EXPECT_EQ(drive.effort, 0);
  EXPECT_EQ(drive.stiffness, 100);
  EXPECT_EQ(drive.damping, 2);
  EXPECT_EQ(drive.max_effort, 30);
  EXPECT_DOUBLE_EQ(drive.target_position, 0.1 + 5.0 / 100);
  EXPECT_FALSE(motor.accept(drive, {0, 0, 0}, STEP));
  EXPECT_TRUE(motor.accept(drive, {-0.2, 0, 0}, STEP));
}

TEST(JointMotor, VelocityAloneIsDampingAlone) {
  JointMotor motor(settings(MotorLaw::PID, {100, 10, 2}), 0);
  motor.keepVelocity(1.5, 0);
  motor.sample(0, STEP);
  EXPECT_DOUBLE_EQ(motor.drive({0.7, 1, 0}).effort, 2 * 0.5);
  // A trajectory that follows starts where the joint is.
  motor.follow(0, 0, {{1, 2.0, 0, 0, 0, 1}}, 0.7);
  EXPECT_DOUBLE_EQ(motor.desired(0).position, 0.7);
  EXPECT_DOUBLE_EQ(motor.desired(0.5).position, 1.35);
}

TEST(JointMotor, NothingOfBeforeAddsToAVelocity) {
  for (const MotorLaw law : {MotorLaw::PID, MotorLaw::IMPLICIT_PD}) {
    JointMotor motor(settings(law, {100, 1000, 2, 50}), 0);
    motor.follow(0, 0, {{0.001, 0.5, 0, 0, 7, 1}}, 0);
    for (int i = 0; i < 100; ++i) {
      motor.sample(i * STEP, STEP);
      motor.accept(motor.drive({0, 0, 0}), {0, 0, 0}, STEP);
    }
    motor.keepVelocity(1.5, 0);
    motor.sample(0.1, STEP);
    const dynamics::JointDrive drive = motor.drive({0.7, 1, 0});
    EXPECT_DOUBLE_EQ(drive.effort + drive.damping * (drive.target_velocity - 1), 2 * 0.5);
    EXPECT_EQ(drive.stiffness, 0);
    motor.accept(drive, {0.7, 1, 0}, STEP);
    // An effort that is commanded beside it still adds.
    motor.addEffort(3);
    motor.sample(0.101, STEP);
    const dynamics::JointDrive pushed = motor.drive({0.7, 1, 0});
    EXPECT_DOUBLE_EQ(pushed.effort + pushed.damping * (pushed.target_velocity - 1), 2 * 0.5 + 3);
  }
}

/** Arm of 1 kg, 0.3 m from its hinge, which stands 0.1 m from the axis of a spindle. */
SimulationConfig armOnSpindle(double arm_damping, double velocity_limit) {
  const std::string inertial = R"(<mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>)";
  SimulationConfig config;
  config.gravity.setZero();
  config.robots = {robot("governor",
                         fmt::format(R"(<robot name="governor"><link name="base"/><link name="spindle"><inertial>{0}
    <link name="arm"><inertial><origin xyz="0.3 0 0"/>{0}
    <joint name="spin" type="continuous"><parent link="base"/><child link="spindle"/><axis xyz="0 0 1"/></joint>
    <joint name="lift" type="revolute"><parent link="spindle"/><child link="arm"/><origin xyz="0.1 0 0"/><axis xyz="0 -1 0"/>
      <limit lower="-2" upper="2" effort="1000" velocity="{1}"/></joint></robot>)",
                                     inertial, velocity_limit),
                         true)};
  config.robots[0].initial_positions["lift"] = 0.6;
  config.robots[0].motor["spin"] = MotorLaw::IMPLICIT_PD;
  config.robots[0].gains["spin"] = {0, 0, 1e5};
  config.robots[0].gains["lift"] = {400, 0, arm_damping};
  return config;
}

/** A joint that rests on what whirls round is not damped, whatever velocity the free motion leaves it with at the end of a step. */
TEST(JointMotor, Equation7KnowsThatAnArmOnASpindleRests) {
  constexpr double RATE = 10, INERTIA = 0.1;
  for (const double share : {0.03, 0.3}) {
    for (const double velocity_limit : {1.0, 1e4}) {
      Simulator simulator(armOnSpindle(share * INERTIA / STEP, velocity_limit), model::UriResolver());
      simulator.commandJoints(0, {{"spin"}, {}, {RATE}, {}});
      stepFor(&simulator, 2.5);
      const SimulationState state = simulator.save();
      stepFor(&simulator, 0.5);
      const double q = simulator.world().jointState(simulator.robots()[0].joints[1]).position;
      const double load = RATE * RATE * (0.1 + 0.3 * std::cos(q)) * 0.3 * std::sin(q);
      EXPECT_NEAR(400 * (0.6 - q), load, 1e-4 * load) << share << ", " << velocity_limit;
      const std::uint64_t hash = simulator.stateHash();
      simulator.restore(state);
      stepFor(&simulator, 0.5);
      EXPECT_EQ(simulator.stateHash(), hash);
    }
  }
}

TEST(JointMotor, WithoutCommandOnlyFrictionActs) {
  MotorSettings mimic = settings(MotorLaw::PID, {100, 10, 2});
  mimic.commanded = false;
  mimic.friction = {0.3, 0.1};
  JointMotor motor(mimic, 0);
  motor.sample(0, STEP);
  const dynamics::JointDrive drive = motor.drive({1, 1, 0});
  EXPECT_EQ(drive.effort, 0);
  EXPECT_EQ(drive.dry_friction, 0.3);
  EXPECT_EQ(drive.viscous_friction, 0.1);
}

TEST(JointMotor, StateGoesThroughNumbers) {
  JointMotor motor(settings(MotorLaw::PID, {100, 10, 2}), 0.2);
  motor.addEffort(1);
  motor.sample(0, STEP);
  motor.accept(motor.drive({0, 0, 0}), {}, STEP);
  motor.keepVelocity(0.4, 0);
  geometry::StateContent saved;
  geometry::StateWriter writer(&saved);
  motor.save(&writer);
  JointMotor copy(settings(MotorLaw::PID, {100, 10, 2}), 0);
  geometry::StateReader reader(saved);
  copy.restore(&reader);
  EXPECT_EQ(reader.numbersLeft(), 0u);
  for (JointMotor* m : {&motor, &copy}) m->sample(STEP, STEP);
  EXPECT_EQ(motor.drive({0.1, 0.1, 0}).effort, copy.drive({0.1, 0.1, 0}).effort);
  copy.reset();
  EXPECT_EQ(copy.desired(0).position, 0);
}

// The pendulum's weight: 2 kg at 0.5 m, horizontal; the hinge's +y axis turns the arm downwards.
constexpr double WEIGHT_TORQUE = 2 * G * 0.5;

Simulator pendulum(MotorLaw law, const JointGains& gains, const std::string& extras = "") {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(extras), true)};
  config.robots[0].gains["default"] = gains;
  config.robots[0].motor["default"] = law;
  return Simulator(config, model::UriResolver());
}

TEST(MotorOnPendulum, StaticErrorIsTorqueOverStiffness) {
  for (const MotorLaw law : {MotorLaw::PID, MotorLaw::IMPLICIT_PD}) {
    Simulator simulator = pendulum(law, {1000, 0, 60});
    stepFor(&simulator, 4);
    const dynamics::JointState state = simulator.report().joints[0];
    EXPECT_NEAR(1000 * state.position, WEIGHT_TORQUE * std::cos(state.position), 1e-6);
    EXPECT_NEAR(state.effort, -WEIGHT_TORQUE * std::cos(state.position), 1e-6);
    EXPECT_FALSE(simulator.report().status & EFFORT_SATURATED);
  }
}

TEST(MotorOnPendulum, IntegralRemovesTheStaticError) {
  for (const MotorLaw law : {MotorLaw::PID, MotorLaw::IMPLICIT_PD}) {
    Simulator simulator = pendulum(law, {1000, 2000, 60});
    stepFor(&simulator, 10);
    EXPECT_NEAR(simulator.report().joints[0].position, 0, 1e-5);
  }
}

TEST(MotorOnPendulum, ImplicitLawIsStableForAnyGain) {
  Simulator simulator = pendulum(MotorLaw::IMPLICIT_PD, {1e7, 0, 1e5});
  stepFor(&simulator, 1);
  EXPECT_NEAR(simulator.report().joints[0].position, WEIGHT_TORQUE / 1e7, 1e-8);
}

TEST(MotorOnPendulum, WeakMotorSaturatesAndSays) {
  for (const MotorLaw law : {MotorLaw::PID, MotorLaw::IMPLICIT_PD}) {
    SimulationConfig config;
    config.robots = {robot("pendulum", pendulumUrdf(), true)};
    config.robots[0].gains["default"] = {1000, 0, 60};
    config.robots[0].motor["default"] = law;
    config.robots[0].effort_limits["hinge"] = 5;
    Simulator simulator(config, model::UriResolver());
    stepFor(&simulator, 0.2);
    EXPECT_TRUE(simulator.report().status & EFFORT_SATURATED);
    EXPECT_NEAR(simulator.report().joints[0].effort, -5, 1e-9);
    EXPECT_GT(simulator.report().joints[0].position, 0.05);
  }
}

TEST(MotorOnPendulum, DryFrictionHoldsTheArmWithoutAMotor) {
  Simulator held = pendulum(MotorLaw::PID, {}, R"(<dynamics friction="12" damping="0"/>)");
  stepFor(&held, 1);
  EXPECT_NEAR(held.report().joints[0].position, 0, 1e-6);
  Simulator falling = pendulum(MotorLaw::PID, {}, R"(<dynamics friction="8" damping="0"/>)");
  stepFor(&falling, 0.1);
  // I = 0.02 + 2 * 0.5^2 about the hinge.
  EXPECT_NEAR(falling.report().joints[0].velocity, (WEIGHT_TORQUE - 8) / 0.52 * 0.1, 0.002);
}

TEST(MotorOnPendulum, LimitIsSaid) {
  Simulator simulator = pendulum(MotorLaw::PID, {});
  stepFor(&simulator, 0.1);
  EXPECT_FALSE(simulator.report().status & JOINT_LIMIT_HIT);
  SimulationConfig config;
  std::string urdf = pendulumUrdf();
  urdf.replace(urdf.find("upper=\"3\""), 9, "upper=\"0.1\"");
  config.robots = {robot("pendulum", urdf, true)};
  Simulator stopped(config, model::UriResolver());
  stepFor(&stopped, 1);
  EXPECT_TRUE(stopped.report().status & JOINT_LIMIT_HIT);
  EXPECT_NEAR(stopped.report().joints[0].position, 0.1, 1e-4);
}

}  // namespace
}  // namespace blem_sim::sim
