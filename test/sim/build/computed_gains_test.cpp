// Robots without gains: loads of their joints in closed form, and poses that hold.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/input_error.h"
#include "build/joint_loads.h"
#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr double PENDULUM_INERTIA = 0.02 + 2 * 0.25, PENDULUM_WEIGHT = 2 * 0.5 * G;

model::LumpedRobot lumped(const std::string& urdf, bool fixed_base) {
  return model::lumpFixedJoints(model::loadUrdf(urdf, "test", model::UriResolver()), {}, fixed_base);
}

SimulationConfig heldPendulum() {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(), true)};
  config.robots[0].motors = MotorDefault::COMPUTED;
  config.robots[0].motor.clear();
  return config;
}

/** A chain of sliders or hinges along x, each link of 1 kg and 0.2 m. */
std::string chainUrdf(int links, const std::string& type, double effort) {
  const std::string inertial =
      R"(<inertial><origin xyz="0.1 0 0"/><mass value="1"/><inertia ixx="0.001" iyy="0.004" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial>)";
  std::string urdf = fmt::format(R"(<robot name="chain"><link name="link0">{}</link>)", inertial);
  for (int i = 1; i <= links; ++i)
    urdf +=
        fmt::format(R"(<link name="link{0}">{1}</link><joint name="joint{0}" type="{2}"><parent link="link{3}"/><child link="link{0}"/>)"
                    R"(<origin xyz="0.2 0 0"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="{4}" velocity="100"/></joint>)",
                    i, inertial, type, i - 1, effort);
  return urdf + "</robot>";
}

TEST(JointLoads, OfAPendulum) {
  const JointLoad load = jointLoads(lumped(pendulumUrdf(), true), {0.7}, true, G)[0];
  EXPECT_NEAR(load.child.inertia, PENDULUM_INERTIA, 1e-12);
  EXPECT_NEAR(load.child.weight, PENDULUM_WEIGHT, 1e-12);
  EXPECT_EQ(load.rest.inertia, 0);
  EXPECT_EQ(load.rest.weight, 0);
}

TEST(JointLoads, OfAFreeChainHaveTwoSides) {
  const std::vector<JointLoad> loads = jointLoads(lumped(chainUrdf(2, "revolute", 100), false), {0, 0}, false, G);
  // Rods with their centres 0.1 and 0.3 m from the joint on either side.
  const double one = 0.004 + 0.01, two = 2 * 0.004 + 0.01 + 0.09;
  EXPECT_NEAR(loads[0].child.inertia, two, 1e-12);
  EXPECT_NEAR(loads[0].rest.inertia, one, 1e-12);
  EXPECT_NEAR(loads[1].child.inertia, one, 1e-12);
  EXPECT_NEAR(loads[1].rest.inertia, two, 1e-12);
  EXPECT_NEAR(loads[1].child.weight, 0.1 * G, 1e-12);
  EXPECT_NEAR(loads[1].rest.weight, 0.4 * G, 1e-12);
  EXPECT_NEAR(lightInertia(loads[0]), one * two / (one + two), 1e-12);
  const JointLoad slider = jointLoads(lumped(chainUrdf(2, "prismatic", 100), true), {0, 0}, true, G)[0];
  EXPECT_EQ(slider.child.inertia, 2);
  EXPECT_NEAR(slider.child.weight, 2 * G, 1e-12);
}

TEST(ComputedGains, SagAndDampingAreAsStated) {
  const model::LumpedJoint joint = lumped(pendulumUrdf(), true).joints[0];
  const JointLoad load{{PENDULUM_INERTIA, PENDULUM_WEIGHT}, {}};
  const double infinity = std::numeric_limits<double>::infinity();
  const JointGains gains = computedGains(load, joint, infinity);
  EXPECT_NEAR(gains.p, PENDULUM_WEIGHT / 1e-3, 1e-9);
  EXPECT_NEAR(gains.d, 2 * std::sqrt(gains.p * PENDULUM_INERTIA), 1e-9);
  // Nothing to hold, or a motor that cannot: 10 Hz of what the child carries, damped as fast.
  const double slow = 4 * M_PI * M_PI * 100;
  for (const double effort : {infinity, 1e-6}) {
    const JointGains weak = computedGains({{0.5, effort < 1 ? 10 : 0.0}, {30, 0}}, joint, effort);
    EXPECT_NEAR(weak.p, 0.5 * slow, 1e-9);
    EXPECT_NEAR(weak.d, 2 * weak.p / std::sqrt(slow), 1e-9);
  }
}

TEST(ComputedGains, APendulumHoldsItsPoseAndDoesNotRing) {
  for (const char* stepper : {"articulated", "world_step", "quick_step"}) {
    SimulationConfig config = heldPendulum();
    config.solver.stepper = stepper;
    Simulator simulator(config, model::UriResolver());
    double last = 0;
    for (int i = 0; i < 10000; ++i) {
      const dynamics::JointState state = simulator.step().joints[0];
      EXPECT_GT(state.position, last - 1e-9) << stepper << " rings at step " << i;
      last = std::max(last, state.position);
    }
    EXPECT_NEAR(last, 1e-3, 1e-8) << stepper;
  }
}

/** A hinge with friction, and a finger that follows it at -3 times its angle, with friction of its own and limits that do not fit. */
std::string stiffHandUrdf() {
  const std::string arm = pendulumUrdf(R"(<dynamics friction="12" damping="0"/>)");
  return arm.substr(0, arm.rfind("</robot>")) +
         R"(<link name="finger"><inertial><origin xyz="0 0 0.1"/><mass value="0.5"/>
            <inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
            <joint name="knuckle" type="revolute"><parent link="base"/><child link="finger"/><axis xyz="0 1 0"/>
            <limit lower="50" upper="60" effort="5" velocity="10"/><dynamics friction="2"/><mimic joint="hinge" multiplier="-3"/></joint></robot>)";
}

TEST(ComputedGains, CarryFrictionAndWhatFollows) {
  const model::LumpedRobot robot = lumped(stiffHandUrdf(), true);
  std::vector<JointLoad> loads = jointLoads(robot, {0, 0}, true, G);
  loads[0].friction = 12;
  loads[1].friction = 2;
  addFollowers(robot, &loads);
  EXPECT_NEAR(loads[0].friction, 12 + 3 * 2, 1e-12);
  EXPECT_NEAR(loads[0].child.weight, PENDULUM_WEIGHT + 3 * 0.5 * 0.1 * G, 1e-12);
  EXPECT_NEAR(loads[0].child.inertia, PENDULUM_INERTIA + 9 * (0.001 + 0.5 * 0.01), 1e-12);
  const JointGains gains = computedGains(loads[0], robot.joints[0], 200);
  EXPECT_NEAR(gains.p, (loads[0].child.weight + 18) / 1e-3, 1e-9);
  EXPECT_NEAR(computedGains(loads[0], robot.joints[0], 20).p, 20 / 1e-3, 1e-9) << "more than the motor has";
}

TEST(ComputedGains, ReachTargetsAgainstFriction) {
  for (const char* stepper : {"articulated", "world_step", "quick_step"}) {
    SimulationConfig config = heldPendulum();
    config.solver.stepper = stepper;
    config.robots[0].urdf_xml = stiffHandUrdf();
    Simulator simulator(config, model::UriResolver());
    for (const double target : SANITIZED ? std::vector<double>{0.4, -0.7} : std::vector<double>{0.4, -0.7, 0.0, 1.5}) {
      simulator.commandJoints(0, {{"hinge"}, {target}, {}, {}});
      stepFor(&simulator, 2);
      EXPECT_NEAR(simulator.report().joints[0].position, target, 1.001e-3) << stepper;
      EXPECT_NEAR(simulator.report().joints[1].position, -3 * simulator.report().joints[0].position, 1e-5) << stepper;
    }
  }
}

SimulationConfig heldChain(MotorLaw law) {
  SimulationConfig config;
  config.robots = {robot("chain", chainUrdf(6, "revolute", 1e4), true)};
  config.robots[0].motors = MotorDefault::COMPUTED;
  config.robots[0].motor["default"] = law;
  for (int i = 1; i <= 6; ++i) config.robots[0].initial_positions[fmt::format("joint{}", i)] = i % 2 ? 0.5 : -0.9;
  return config;
}

// Explicit gains that hold such a chain are not stable, so joints without gains have the implicit law in any case.
TEST(ComputedGains, HoldEveryPoseWhateverTheMotor) {
  for (const MotorLaw law : {MotorLaw::IMPLICIT_PD, MotorLaw::PID}) {
    Simulator simulator(heldChain(law), model::UriResolver());
    stepFor(&simulator, 5);
    for (const int j : simulator.robots()[0].joints) {
      const dynamics::JointState state = simulator.report().joints[j];
      EXPECT_NEAR(state.position, simulator.desiredState(0, j).position, 1e-3) << j;
      EXPECT_NEAR(state.velocity, 0, 1e-6) << j;
    }
  }
}

// Gravity slows a joint that keeps a velocity by 1 mrad/s at most.
TEST(ComputedGains, KeepAVelocityUnderLoad) {
  for (const double velocity : {0.0, 0.3}) {
    Simulator simulator(heldPendulum(), model::UriResolver());
    simulator.commandJoints(0, {{"hinge"}, {}, {velocity}, {}});
    for (int i = 0; i < 2000; ++i) {
      simulator.step();
      if (i <= 100) continue;
      ASSERT_NEAR(simulator.report().joints[0].velocity, velocity, 1.001e-3) << i;
    }
  }
}

std::string noteOf(const SimulationConfig& config, const std::string& words) {
  const Simulator simulator(config, model::UriResolver());
  for (const std::string& note : simulator.notes())
    if (note.find(words) != std::string::npos) return note;
  return "";
}

TEST(ComputedGains, AreTold) {
  EXPECT_EQ(noteOf(heldPendulum(), "computed gains").find("pendulum: computed gains"), 0u);
  EXPECT_NE(noteOf(heldPendulum(), "computed gains").find("hinge 9.81e+03 143"), std::string::npos) << noteOf(heldPendulum(), "computed");
  SimulationConfig many = heldPendulum();
  many.robots[0].urdf_xml = chainUrdf(50, "revolute", 1e4);
  const std::string note = noteOf(many, "computed gains");
  EXPECT_NE(note.find("joint12 "), std::string::npos) << note;
  EXPECT_EQ(note.find("joint13 "), std::string::npos) << note;
  EXPECT_NE(note.find("and 38 more"), std::string::npos) << note;
  EXPECT_NE(noteOf(heldChain(MotorLaw::PID), "motor: pid").find("joint1, joint2"), std::string::npos);
  EXPECT_EQ(noteOf(heldChain(MotorLaw::IMPLICIT_PD), "motor: pid"), "");
  SimulationConfig stuck = heldPendulum();
  stuck.robots[0].urdf_xml = pendulumUrdf(R"(<dynamics friction="200"/>)");
  EXPECT_NE(noteOf(stuck, "'hinge' has dry friction of 200").find("set joint_friction or effort_limits"), std::string::npos);
  SimulationConfig free = heldPendulum();
  free.robots[0].motors = MotorDefault::FREE;
  EXPECT_NE(noteOf(free, "move freely").find("hinge"), std::string::npos);
}

TEST(ComputedGains, AnEffortLimitOf0IsToldOnceUnlessTheConfigurationHasAnother) {
  SimulationConfig config;
  config.robots = {robot("chain", chainUrdf(1, "revolute", 0), true)};
  config.robots[0].motors = MotorDefault::COMPUTED;
  const auto told = [&] {
    const Simulator simulator(config, model::UriResolver());
    const auto tells = [](const std::string& note) { return note.find("effort limit") != std::string::npos; };
    return std::count_if(simulator.notes().begin(), simulator.notes().end(), tells);
  };
  EXPECT_EQ(told(), 1);
  config.robots[0].effort_limits = {{"joint1", 50}};
  EXPECT_EQ(told(), 0);
}

// Gazebo moves what a transmission names.
TEST(ComputedGains, OnlyForTransmissionsIfAsked) {
  for (const bool with : {false, true}) {
    SimulationConfig config = heldPendulum();
    config.robots[0].motors = MotorDefault::TRANSMISSIONS;
    std::string& urdf = config.robots[0].urdf_xml;
    if (with) urdf.insert(urdf.find("</robot>"), R"(<transmission name="t"><joint name="hinge"/></transmission>)");
    Simulator simulator(config, model::UriResolver());
    stepFor(&simulator, 1);
    EXPECT_EQ(std::abs(simulator.report().joints[0].position) < 2e-3, with);
  }
}

TEST(ComputedGains, GainsOfGazeboRosControl) {
  SimulationConfig config = heldPendulum();
  config.robots[0].pid_gains = {{"hinge", {500, 0, 40}}, {"of another robot", {1, 1, 1}}};
  Simulator simulator(config, model::UriResolver());
  EXPECT_EQ(noteOf(config, "computed gains"), "");
  stepFor(&simulator, 4);
  const double position = simulator.report().joints[0].position;
  EXPECT_NEAR(500 * position, PENDULUM_WEIGHT * std::cos(position), 1e-3);
  config.robots[0].gains["default"] = {1000, 0, 40};
  Simulator configured(config, model::UriResolver());
  stepFor(&configured, 4);
  EXPECT_LT(configured.report().joints[0].position, 0.6 * position) << "the configuration's beat them";
  config.robots[0].pid_gains["hinge"].d = -1;
  EXPECT_THROW(Simulator(config, model::UriResolver()), InputError);
}

TEST(ComputedGains, GivenGainsStandAsTheyAre) {
  SimulationConfig config = heldPendulum();
  config.robots[0].gains["hinge"] = {};
  EXPECT_EQ(noteOf(config, "computed gains"), "");
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.1);
  EXPECT_NEAR(simulator.report().joints[0].velocity, PENDULUM_WEIGHT / PENDULUM_INERTIA * 0.1, 0.01) << "gains of 0 are no motor";
}

}  // namespace
}  // namespace blem_sim::sim
