// Models welded to others: they go along, weigh what they weigh, break where they should, and come loose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "blem_sim/sim/named_parts.h"
#include "sim/simulation_scene.h"
#include "support/input_errors.h"

namespace blem_sim::sim {
namespace {

constexpr double UNBREAKABLE = std::numeric_limits<double>::infinity();

/** A carriage of 2 kg that a motor moves up and down over the ground; its plate is 0.1 m wide. */
std::string carriageUrdf() {
  return R"(<robot name="carriage"><link name="base"/>
    <link name="plate"><inertial><mass value="2"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
      <collision><geometry><box size="0.1 0.1 0.02"/></geometry></collision></link>
    <joint name="lift" type="prismatic"><parent link="base"/><child link="plate"/><axis xyz="0 0 1"/>
      <limit lower="-1" upper="1" effort="1000" velocity="10"/></joint></robot>)";
}

/** The carriage at 1 m, and a cube of 1 kg that hangs below its plate, touching nothing. */
SimulationConfig carriageAndCube() {
  SimulationConfig config;
  config.environments = {ground()};
  config.robots = {robot("carriage", carriageUrdf(), true)};
  config.robots[0].X_WR = makePose({0, 0, 1});
  config.robots[0].gains["default"] = {1e4, 0, 1e3};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.02, 0.01, 0.9})};
  return config;
}

LinkPart plateOf(const Simulator& simulator) { return findLink(simulator, "carriage::plate", "part"); }

Pose placeOnPlate(const Simulator& simulator) {
  return simulator.report().bodies[plateOf(simulator).body].X_WB.inverse() * bodyOf(simulator, "cube").X_WB;
}

TEST(Attachments, GoAlongAndFallWhenTheyAreDetached) {
  Simulator simulator(carriageAndCube(), model::UriResolver());
  simulator.attach("cube", plateOf(simulator), UNBREAKABLE, UNBREAKABLE);
  const Pose place = placeOnPlate(simulator);
  simulator.commandJoints(0, {{"lift"}, {0.3}, {}, {}});
  double apart = 0, rise = 0;
  for (int i = 0; i < 3000; ++i) {
    simulator.step();
    apart = std::max(apart, (placeOnPlate(simulator).matrix() - place.matrix()).cwiseAbs().maxCoeff());
    rise = std::max(rise, bodyOf(simulator, "cube").X_WB.translation().z() - 0.9);
  }
  EXPECT_LT(apart, 1e-12);
  EXPECT_GT(rise, 0.25);
  EXPECT_NEAR(simulator.attachments().at(0).wrench.force.z(), G, 1e-6);  // from the plate on the cube
  simulator.detach("cube");
  EXPECT_TRUE(simulator.attachments().empty());
  const double height = bodyOf(simulator, "cube").X_WB.translation().z();
  stepFor(&simulator, 0.1);
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), height - 0.5 * G * 0.1 * 0.101, 1e-9);
}

TEST(Attachments, BreakBeyondTheirForceAndTellIt) {
  for (const double limit : {0.999 * G, 1.001 * G}) {
    Simulator simulator(carriageAndCube(), model::UriResolver());
    simulator.attach("cube", plateOf(simulator), UNBREAKABLE, UNBREAKABLE);
    stepFor(&simulator, 2);  // then the carriage stands still
    simulator.detach("cube");
    simulator.attach("cube", plateOf(simulator), limit, UNBREAKABLE);
    int broken = 0;
    for (int i = 0; i < 200; ++i)
      for (const std::string& model : simulator.step().broken_attachments) broken += model == "cube";
    EXPECT_EQ(broken, limit < G ? 1 : 0) << limit;
    EXPECT_EQ(simulator.attachments().empty(), limit < G) << limit;
  }
}

constexpr double CUBE_INERTIA = 0.01 / 6;  // [kg m^2] of 1 kg and 0.1 m

/** A cube that flies past another is welded to it: both stick, as after a plastic impact, and turn about their common centre. */
TEST(Attachments, TwoBodiesThatFlyComeToMoveAsOne) {
  for (const char* stepper : {"articulated", "world_step"}) {
    SimulationConfig config;
    config.solver.stepper = stepper;
    config.gravity = Vector3::Zero();
    config.objects = {box("a", Vector3::Constant(0.1), 1, {0, 0, 0}), box("b", Vector3::Constant(0.1), 1, {0.3, 0, 0})};
    config.objects[1].linear_velocity = {0, 0.9, 0};
    const double spin = 2 * 0.15 * 0.45 / (2 * CUBE_INERTIA + 2 * 0.15 * 0.15);
    Simulator simulator(config, model::UriResolver());
    simulator.attach("b", findLink(simulator, "a::link", "part"), UNBREAKABLE, UNBREAKABLE);
    for (int i = 0; i < 500; ++i) {
      simulator.step();
      const dynamics::BodyState a = bodyOf(simulator, "a"), b = bodyOf(simulator, "b");
      EXPECT_NEAR((a.v_WCom + b.v_WCom - Vector3(0, 0.9, 0)).norm(), 0, 1e-9) << stepper;
      EXPECT_NEAR(a.w_WB.z(), spin, 2e-3) << stepper;
      EXPECT_NEAR(b.w_WB.z(), a.w_WB.z(), 1e-5) << stepper;
      EXPECT_NEAR((b.X_WB.translation() - a.X_WB.translation()).norm(), 0.3, 1e-5) << stepper;
    }
    // Each feels what keeps it on its circle of 0.15 m.
    EXPECT_NEAR(simulator.attachments().at(0).wrench.force.norm(), spin * spin * 0.15, 3e-3) << stepper;
  }
}

/** An arm that swings at 2 rad/s takes a cube along that was at rest 0.8 m from its hinge: the momentum about the hinge stays. */
TEST(Attachments, AnArmThatTakesAThingAlongSlowsDown) {
  SimulationConfig config;
  config.gravity = Vector3::Zero();
  config.robots = {robot("arm", pendulumUrdf(), true)};
  config.objects = {box("cube", Vector3::Constant(0.1), 1, {0.8, 0, 1})};
  Simulator simulator(config, model::UriResolver());
  const double inertia = 0.02 + 2 * 0.25, with_cube = inertia + 0.64 + CUBE_INERTIA;
  simulator.applyEffort(simulator.robots()[0].joints[0], 2 * inertia / config.time_step, {0, config.time_step});
  EXPECT_NEAR(simulator.step().joints[0].velocity, 2, 1e-9);
  simulator.attach("cube", findLink(simulator, "arm::arm", "part"), UNBREAKABLE, UNBREAKABLE);
  EXPECT_NEAR(simulator.step().joints[0].velocity, 2 * inertia / with_cube, 1e-5);
  EXPECT_NEAR(bodyOf(simulator, "cube").v_WCom.norm(), 0.8 * 2 * inertia / with_cube, 1e-5);
  simulator.detach("cube");
  EXPECT_NEAR(simulator.step().joints[0].velocity, 2 * inertia / with_cube, 1e-5);
}

TEST(Attachments, CarryWhatIsMovedAndComeLooseInAReset) {
  Simulator simulator(carriageAndCube(), model::UriResolver());
  simulator.attach("cube", plateOf(simulator), UNBREAKABLE, UNBREAKABLE);
  simulator.setJointPositions(0, {"lift"}, {0.5});
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), 1.4, 1e-12);
  const std::string moved =
      refusal([&] { simulator.moveModel(simulator.models()[simulator.modelIndex("cube")].bodies[0], dynamics::BodyState()); });
  EXPECT_NE(moved.find("'cube' is attached to 'carriage::plate'; detach it first"), std::string::npos) << moved;
  const SimulationState state = simulator.save();
  stepFor(&simulator, 0.2);
  const std::uint64_t hash = simulator.stateHash();
  simulator.restore(state);
  stepFor(&simulator, 0.2);
  EXPECT_EQ(simulator.stateHash(), hash);
  simulator.resetWorld();
  EXPECT_TRUE(simulator.attachments().empty());
  EXPECT_NEAR(bodyOf(simulator, "cube").X_WB.translation().z(), 0.9, 1e-12);
  const std::string other = refusal([&] { simulator.restore(state); });
  EXPECT_NE(other.find("cube::attached"), std::string::npos) << other;
  simulator.attach("cube", plateOf(simulator), UNBREAKABLE, UNBREAKABLE);
  simulator.removeModel("carriage");
  EXPECT_TRUE(simulator.attachments().empty());
  stepFor(&simulator, 0.1);
  EXPECT_LT(bodyOf(simulator, "cube").v_WCom.z(), -0.9);
}

TEST(Attachments, DoNotTouchWhatCarriesThem) {
  SimulationConfig config = carriageAndCube();
  config.objects[0].X_WO = makePose({0.02, 0.01, 0.95});  // inside the plate
  Simulator simulator(config, model::UriResolver());
  simulator.attach("cube", plateOf(simulator), UNBREAKABLE, UNBREAKABLE);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(simulator.step().contacts.empty());
  simulator.detach("cube");
  EXPECT_FALSE(simulator.step().contacts.empty());
}

/** Two cubes in each other at the plate: while both hang there they do not touch; once one is let go it is led out of the other. */
TEST(Attachments, TwoOfOnePartTouchOnceOneIsGone) {
  SimulationConfig config = carriageAndCube();
  config.objects.push_back(box("other", Vector3::Constant(0.1), 1, {-0.02, -0.01, 0.85}));
  for (const char* first : {"cube", "other"}) {
    Simulator simulator(config, model::UriResolver());
    const LinkPart plate = plateOf(simulator);
    for (const char* cube : {"cube", "other"}) simulator.attach(cube, plate, UNBREAKABLE, UNBREAKABLE);
    for (int i = 0; i < 20; ++i) EXPECT_TRUE(simulator.step().contacts.empty());
    simulator.detach(first);
    EXPECT_FALSE(simulator.step().contacts.empty()) << first;
    simulator.detach(first == std::string("cube") ? "other" : "cube");
    EXPECT_FALSE(simulator.step().contacts.empty()) << first;
  }
}

TEST(Attachments, RefuseInWords) {
  Simulator simulator(carriageAndCube(), model::UriResolver());
  const LinkPart plate = plateOf(simulator);
  const auto attach = [&](const std::string& object, const LinkPart& part, double force) {
    return refusal([&] { simulator.attach(object, part, force, UNBREAKABLE); });
  };
  EXPECT_NE(attach("cub", plate, 1).find("cube"), std::string::npos);
  EXPECT_NE(attach("carriage", plate, 1).find("is fixed to the world"), std::string::npos);
  EXPECT_NE(attach("ground", plate, 1).find("is fixed to the world"), std::string::npos);
  EXPECT_NE(attach("cube", plate, 0).find("max_force: is 0"), std::string::npos);
  EXPECT_NE(attach("cube", plate, NAN).find("max_force: is nan"), std::string::npos);
  EXPECT_NE(attach("cube", findLink(simulator, "cube::link", "part"), 1).find("hangs on"), std::string::npos);
  EXPECT_NE(refusal([&] { simulator.detach("cube"); }).find("'cube' is not attached"), std::string::npos);
  EXPECT_EQ(attach("cube", plate, 100), "");
  EXPECT_NE(attach("cube", plate, 100).find("is attached to 'carriage::plate' already"), std::string::npos);
  EXPECT_EQ(simulator.attachments().size(), 1u);
}

}  // namespace
}  // namespace blem_sim::sim
