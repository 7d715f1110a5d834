// Ropes of light links that carry heavy things, at a time step that is too long for a link's swing.
#include "guard/taut_links.h"

#include <algorithm>
#include <cmath>

#include "sim/guard/rope_scene.h"

namespace blem_sim::sim {
namespace {

/** Speeds of both weights [m/s] upwards, and what the drum carries [N]. */
struct RopeFigures {
  double left = 0, right = 0, carried = 0;
  std::uint32_t status = 0;
};

RopeFigures hang(Simulator* simulator, int steps) {
  RopeFigures figures;
  for (int i = 0; i < steps; ++i) figures.status |= simulator->step().status;
  const StepReport& report = simulator->report();
  figures.left = report.bodies.front().v_WCom.z();
  figures.right = report.bodies.back().v_WCom.z();
  for (const ContactReport& contact : report.contacts)
    figures.carried += (contact.body_a == dynamics::WORLD_BODY ? -1 : 1) * contact.force.z();
  return figures;
}

class RopeHolds : public testing::TestWithParam<double> {};

// Before solves were bounded by the swings of links, the rope fell through the drum within 20 steps, and no bit told it.
TEST_P(RopeHolds, OverADrumWithTheWeightsOfItsEnds) {
  RopeOverDrum rope;
  rope.right = GetParam();
  ASSERT_LT(rope.right, rope.holds());
  Simulator simulator(ropeOverDrum(rope), model::UriResolver());
  const RopeFigures figures = hang(&simulator, 150);
  EXPECT_EQ(figures.status, STEP_SHORTENED);
  EXPECT_LT(std::abs(figures.left), 1e-3);
  EXPECT_LT(std::abs(figures.right), 1e-3);
  EXPECT_NEAR(figures.carried, rope.weight(), 0.02 * rope.weight());
}

INSTANTIATE_TEST_SUITE_P(Ratios, RopeHolds, testing::Values(1, 1.5, 2.2));

TEST(TautLinks, ARopeSlidesOverADrumAsEulerAndEytelweinSay) {
  RopeOverDrum rope;
  rope.around = 32, rope.length = 0.005, rope.radius = 0.0015;
  rope.right = 3.5;
  Simulator simulator(ropeOverDrum(rope), model::UriResolver());
  hang(&simulator, 20);
  const double before = hang(&simulator, 0).left;
  const RopeFigures figures = hang(&simulator, 50);
  const double expected = G * (rope.right - rope.holds() * rope.left) / (rope.right + rope.holds() * rope.left);
  EXPECT_NEAR((figures.left - before) / 0.05, expected, 0.1 * expected);
  EXPECT_NEAR(figures.right, -figures.left, 0.05 * figures.left);
}

TEST(TautLinks, WithArmatureTakeWholeSteps) {
  RopeOverDrum rope;
  rope.armature = 1e-7;  // tension, length and the square of the time step
  Simulator simulator(ropeOverDrum(rope), model::UriResolver());
  const RopeFigures figures = hang(&simulator, 150);
  EXPECT_EQ(figures.status, STEP_OK);
  EXPECT_LT(std::abs(figures.left), 1e-3);
  EXPECT_NEAR(figures.carried, rope.weight(), 0.02 * rope.weight());
}

TEST(TautLinks, DampedOnesTakeWholeSteps) {
  RopeOverDrum rope;
  SimulationConfig config = ropeOverDrum(rope);
  config.robots[0].joint_friction["default"].viscous = 1e-3;
  Simulator simulator(config, model::UriResolver());
  const RopeFigures figures = hang(&simulator, 150);
  EXPECT_EQ(figures.status, STEP_OK);
  EXPECT_LT(std::abs(figures.left), 1e-3);
  EXPECT_NEAR(figures.carried, rope.weight(), 0.02 * rope.weight());
}

TEST(TautLinks, PartsOfTheNextStepArePartOfTheState) {
  Simulator simulator(ropeOverDrum({}), model::UriResolver()), other(ropeOverDrum({}), model::UriResolver());
  hang(&simulator, 30);
  const SimulationState state = simulator.save();
  hang(&other, 3);
  other.restore(state);
  EXPECT_EQ(other.stateHash(), simulator.stateHash());
  hang(&simulator, 10);
  hang(&other, 10);
  EXPECT_EQ(other.stateHash(), simulator.stateHash());
  simulator.resetWorld();
  Simulator fresh(ropeOverDrum({}), model::UriResolver());
  hang(&simulator, 10);
  hang(&fresh, 10);
  EXPECT_EQ(simulator.report().bodies.back().X_WB.translation(), fresh.report().bodies.back().X_WB.translation());
}

// A rod between two hinges that is pulled by T swings at sqrt(12 T / (m l)).
TEST(TautLinks, ARodTakesASolveAsLongAsItsSwingSays) {
  SimulationConfig config;
  RobotConfig robot;
  robot.name = "rods";
  robot.fixed_base = true;
  robot.motors = MotorDefault::FREE;
  const double mass = 0.01, length = 0.1, load = 2, across = mass * length * length / 12;
  const auto rod = [&](const std::string& name, double of_mass, double of_inertia) {
    return fmt::format(
        "<link name='{}'><inertial><origin xyz='0 0 {}'/><mass value='{}'/><inertia ixx='{}' iyy='{}' izz='1e-6' ixy='0' ixz='0' iyz='0'/>"
        "</inertial></link>",
        name, -0.5 * length, of_mass, of_inertia, of_inertia);
  };
  const auto hinge = [&](const std::string& name, const std::string& parent, const std::string& child, double z) {
    return fmt::format(
        "<joint name='{}' type='continuous'><parent link='{}'/><child link='{}'/><origin xyz='0 0 {}'/><axis xyz='0 1 0'/></joint>", name,
        parent, child, z);
  };
  robot.urdf_xml = "<robot name='rods'><link name='base'/>" + rod("rod", mass, across) + rod("load", load, 0.1) +
                   hinge("upper", "base", "rod", 0) + hinge("lower", "rod", "load", -length) + "</robot>";
  config.robots = {robot};
  Simulator simulator(config, model::UriResolver());
  simulator.step();
  const dynamics::World& world = simulator.world();
  std::vector<dynamics::BodyState> bodies = simulator.report().bodies;
  FoundContacts start;
  SolverContacts contacts;
  std::vector<dynamics::JointDrive> drives(world.jointCount());
  dynamics::SolveResult result;
  result.joint_wrenches.resize(world.jointCount());
  const double pull = load * G;
  for (int joint = 0; joint < world.jointCount(); ++joint) result.joint_wrenches[joint].force = Vector3(0, 0, pull);
  const MadeSolve made{start, contacts, drives, result, bodies, bodies, 0.001};
  TautLinks links;
  EXPECT_TRUE(std::isinf(links.longestSolve(world, made))) << "nothing touches it, and its motion was followed";
  result.too_fast = true;
  EXPECT_NEAR(links.longestSolve(world, made), 1.5 / std::sqrt(12 * pull / (mass * length)), 1e-12);
  for (Wrench& wrench : result.joint_wrenches) wrench.force = -wrench.force;
  EXPECT_TRUE(std::isinf(links.longestSolve(world, made))) << "it is pressed";
  for (Wrench& wrench : result.joint_wrenches) wrench.force = -wrench.force;
  drives[0].stiffness = 1;
  EXPECT_TRUE(std::isinf(links.longestSolve(world, made))) << "a motor holds it";
}

}  // namespace
}  // namespace blem_sim::sim
