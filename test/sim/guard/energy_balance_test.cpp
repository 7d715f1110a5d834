// Energy out of nothing, island by island: books of hand-made solves, then scenes that must not set the bit.
#include "guard/energy_balance.h"

#include <cmath>
#include <iterator>

#include "sim/guard/booked_solves.h"

namespace blem_sim::sim {
namespace {

TEST(EnergyBalance, OneBodysGainIsNotHiddenByAnothersLoss) {
  HandMadeSolve solve(2);
  solve.before[1].v_WCom = {3, 0, 0};
  solve.after[0].v_WCom = {1, 0, 0};
  const EnergyGain gain = solve.gain();
  EXPECT_NEAR(gain.total, 1, 1e-12);
  EXPECT_NEAR(gain.out_of_nothing, 1, 1e-12);
  EXPECT_TRUE(gain.beyond_bound);
}

TEST(EnergyBalance, WhatAJointTiesIsOneIsland) {
  HandMadeSolve solve(3);
  dynamics::JointSpec joint;
  joint.kind = dynamics::JointKind::PRISMATIC;
  joint.parent = 0;
  joint.child = 1;
  joint.axis = Vector3::UnitX();
  solve.world.addJoint(joint);
  solve.before[1].v_WCom = {3, 0, 0};
  solve.after[0].v_WCom = {1, 0, 0};
  EXPECT_EQ(solve.gain().total, 0);
  solve.after[2].w_WB = {0, 0, 2};
  EXPECT_NEAR(solve.gain().total, 0.6, 1e-12);
}

// A slider that its motor pushes against friction of the same size keeps its speed of 1 m/s. The motor's work, 10 mJ in the step, goes into
// friction and makes up for no gain: a start told 1 mm/s slower is a gain of 0.9995 mJ.
TEST(EnergyBalance, WorkThatFrictionTakesHidesNoGain) {
  dynamics::World world(Vector3::Zero(), dynamics::SolverSettings());
  dynamics::BodySpec slider;
  slider.name = "slider";
  slider.inertial.mass = 1;
  slider.inertial.inertia.setIdentity();
  world.addBody(slider);
  dynamics::JointSpec joint;
  joint.kind = dynamics::JointKind::PRISMATIC;
  joint.child = 0;
  joint.axis = Vector3::UnitX();
  world.addJoint(joint);
  world.setBodyState(0, {Pose::Identity(), Vector3::UnitX(), Vector3::Zero()});
  dynamics::JointDrive drive;
  drive.effort = drive.dry_friction = 10;
  std::vector<dynamics::BodyState> before = {world.bodyState(0)};
  EnergyBalance balance{dynamics::SolverSettings()};
  balance.start(world);
  const dynamics::SolveResult& solved = world.step(BALANCE_STEP, {}, {drive});
  const std::vector<dynamics::BodyState> after = {world.bodyState(0)};
  ASSERT_NEAR(after[0].v_WCom.x(), 1, 1e-9);
  before[0].v_WCom.x() -= 1e-3;
  const FoundContacts start;
  const SolverContacts contacts;
  const std::vector<dynamics::JointDrive> drives = {drive};
  const MadeSolve made{start, contacts, drives, solved, before, after, BALANCE_STEP};
  EXPECT_NEAR(balance.addSolve(world, made, {}).total, 0.9995e-3, 1e-8);
}

TEST(EnergyBalance, FlightGainsNothing) {
  HandMadeSolve solve(1, {0, 0, -G});
  solve.before[0].v_WCom = {20, 0, 30};
  solve.after[0].v_WCom = {20, 0, 30 - G * BALANCE_STEP};
  solve.after[0].X_WB.translation() += BALANCE_STEP * solve.after[0].v_WCom;
  EXPECT_LT(solve.gain().total, 1e-11);
}

TEST(EnergyBalance, ABodyThatTurnsOverOntoAnotherAxisGains) {
  HandMadeSolve solve(1);
  solve.before[0].w_WB = {0, 0, 100};
  solve.after[0].w_WB = {0, 0, 100};
  solve.after[0].X_WB.linear() = makePose(Vector3::Zero(), {0.2, 0.1, 0}).linear();
  EXPECT_LT(solve.gain().total, 1e-9);  // towards the smaller inertia
  std::swap(solve.before[0], solve.after[0]);
  const EnergyGain gain = solve.gain();
  EXPECT_GT(gain.total, 1);
  EXPECT_TRUE(gain.beyond_bound);
}

TEST(EnergyBalance, TheBoundGrowsWithWhatMoves) {
  HandMadeSolve solve(1);
  for (const double speed : {0.0, 1.0, 100.0}) {
    const double bound = EnergyBalance::FLOOR + EnergyBalance::RELATIVE * speed * speed;  // of 2 kg
    for (const double part : {0.9, 1.2}) {
      solve.before[0].v_WCom = {speed, 0, 0};
      solve.after[0].v_WCom = {std::sqrt(speed * speed + part * bound), 0, 0};
      EXPECT_EQ(solve.gain().beyond_bound, part > 1) << speed;
    }
  }
}

TEST(EnergyBalance, ReadsWhatItWrote) {
  EnergyBalance balance{dynamics::SolverSettings()};
  const auto numbers_of_balance = [&](int bodies) {
    geometry::StateContent saved;
    geometry::StateWriter writer(&saved);
    balance.save(bodies, &writer);
    return saved.numbers;
  };
  EXPECT_EQ(numbers_of_balance(2), std::vector<double>{0});
  for (const std::vector<double>& bad : {std::vector<double>{}, {2, 1}, {-1}, {NAN}, {1e300}}) {
    const geometry::StateContent content{bad, {}};
    geometry::StateReader reader(content);
    EXPECT_THROW(balance.restore(2, &reader), InputError);
  }
  const geometry::StateContent held{{2, 0.5, 0}, {}};
  geometry::StateReader reader(held);
  balance.restore(2, &reader);
  EXPECT_EQ(numbers_of_balance(2), held.numbers);
  EXPECT_EQ(numbers_of_balance(3), (std::vector<double>{3, 0.5, 0, 0}));  // a body came
}

TEST(EnergyGainedBit, IsNotSetByAStackNorBySlidingNorByAFall) {
  const Vector3 size = Vector3::Constant(0.1);
  SimulationConfig config = onGround({box("low", size, 1, {0, 0, 0.0525}), box("high", size, 1, {0, 0, 0.1575}),
                                      box("slides", size, 1, {0.5, 0, 0.0525}), box("falls", size, 1, {-0.5, 0, 0.4})});
  config.objects[2].linear_velocity = {2, 0.5, 0};
  config.objects[3].angular_velocity = {5, 3, 1};
  EXPECT_EQ(statusOf(config, 1) & ENERGY_GAINED, 0u);
}

TEST(EnergyOutOfNothing, LeavesOutWhatCorrectingDepthTakes) {
  Simulator simulator(onGround({box("deep", Vector3::Constant(0.1), 1, {0, 0, 0.0515})}), model::UriResolver());
  double gained = 0, out_of_nothing = 0;
  for (int i = 0; i < 300; ++i) {
    const StepReport& report = simulator.step();
    gained += report.energy_gained;
    out_of_nothing += report.energy_out_of_nothing;
  }
  EXPECT_GT(gained, 0.5 * G * 0.001);  // lifted by a millimetre
  EXPECT_LT(out_of_nothing, 1e-9);
}

/** A rod that lands on its end turns at 200 to 280 rad/s after the impact. */
TEST(EnergyOutOfNothing, IsNoneWhereAnImpactSetsARodSpinning) {
  const std::pair<Vector3, Vector3> turns_and_velocities[] = {{{2.420, 2.299, 0.519}, {-1.450, -0.208, -5.245}},
                                                              {{-2.916, 1.122, 2.592}, {-1.063, 0.914, -4.561}},
                                                              {{1.509, 2.928, -2.133}, {-1.112, -1.807, -2.868}},
                                                              {{1.696, 0.692, -0.323}, {1.962, -0.216, -2.274}},
                                                              {{-1.114, -0.862, -1.636}, {-1.301, 1.426, -2.907}}};
  double out_of_nothing = 0;
  for (const auto& [turn, velocity] : turns_and_velocities) {
    ObjectConfig rod = box("rod", {0.006, 0.006, 0.045}, 0.0127, Vector3::Zero());
    rod.X_WO = makePose({0, 0, 0.05}, turn);
    rod.linear_velocity = velocity;
    Simulator simulator(onGround({rod}), model::UriResolver());
    double fastest = 0;
    for (int i = 0; i < 40; ++i) {
      const StepReport& report = simulator.step();
      fastest = std::max(fastest, report.bodies[0].w_WB.norm());
      out_of_nothing = std::max(out_of_nothing, report.energy_out_of_nothing);
    }
    EXPECT_GT(fastest, 180);
  }
  EXPECT_LT(out_of_nothing, 1e-9);
}

/** Fingers of 50 g on the lower bar that follow each other. */
const char* const FINGERS =
    R"(<link name="left"><inertial><mass value="0.05"/><inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <link name="right"><inertial><mass value="0.05"/><inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="first" type="prismatic"><parent link="elbow_bar"/><child link="left"/><origin xyz="0.3 0.02 0"/><axis xyz="0 1 0"/>
      <limit lower="-0.1" upper="0.1" effort="0" velocity="1"/></joint>
    <joint name="second" type="prismatic"><parent link="elbow_bar"/><child link="right"/><origin xyz="0.3 -0.02 0"/><axis xyz="0 -1 0"/>
      <limit lower="-0.1" upper="0.1" effort="0" velocity="1"/><mimic joint="first"/></joint>)";

/** A joint about y and a bar of 1 kg and 0.3 m behind it. @param more of the joint */
std::string barAfter(const std::string& parent, const std::string& joint, const std::string& more) {
  return fmt::format(
      R"(<link name="{1}_bar"><inertial><origin xyz="0.15 0 0"/><mass value="1"/>
      <inertia ixx="0.0007" iyy="0.008" izz="0.008" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <joint name="{1}" {2}<parent link="{0}"/><child link="{1}_bar"/><origin xyz="{3} 0 0"/><axis xyz="0 1 0"/></joint>)",
      parent, joint, more, parent == "base" ? 0 : 0.3);
}

/** An arm of two bars, level at first, that falls and stretches again and again. @param elbow type and more of its second joint */
RobotConfig fallingArm(const std::string& elbow, const std::string& hand) {
  return robot("arm",
               "<robot name=\"arm\"><link name=\"base\"/>" + barAfter("base", "shoulder", "type=\"continuous\">") +
                   barAfter("shoulder_bar", "elbow", elbow) + hand + "</robot>",
               true);
}

/** Velocity products of a straight arm do not tell how fast its mass matrix changes. */
TEST(EnergyOutOfNothing, IsNoneWhereAnArmStretches) {
  struct Arm {
    const char *elbow, *hand;
    double most;  // [J]
  };
  const Arm arms[] = {{R"(type="continuous">)", "", 1e-7},
                      {R"(type="continuous"><dynamics damping="0.001"/>)", "", 3e-6},
                      {R"(type="continuous"><dynamics damping="0" friction="0.01"/>)", "", 3e-6},
                      {R"(type="revolute"><limit lower="-1" upper="1" effort="0" velocity="10"/>)", "", 1e-6},
                      {R"(type="continuous">)", FINGERS, 1e-6},
                      {R"(type="continuous"><mimic joint="shoulder"/>)", "", 1e-6},
                      {R"(type="continuous"><mimic joint="shoulder" multiplier="-3"/>)", "", 1e-6}};
  for (const Arm& arm : arms) {
    SimulationConfig config;
    config.robots = {fallingArm(arm.elbow, arm.hand)};
    Simulator simulator(config, model::UriResolver());
    double out_of_nothing = 0, fastest = 0;
    std::uint32_t status = 0;
    for (int i = 0; i < 4000; ++i) {
      const StepReport& report = simulator.step();
      out_of_nothing = std::max(out_of_nothing, report.energy_out_of_nothing);
      fastest = std::max(fastest, std::abs(simulator.world().jointState(1).velocity));
      status |= report.status;
    }
    EXPECT_LT(out_of_nothing, arm.most) << arm.elbow << arm.hand;
    EXPECT_EQ(status & ENERGY_GAINED, 0u) << arm.elbow << arm.hand;
    EXPECT_GT(fastest, 6) << arm.elbow << arm.hand;
  }
}

/** [J] Most energy out of nothing in a step of an arm whose motors of a stiffness tear it out of rest, time and again. */
double mostWhereMotorsThrowAnArm(double stiffness) {
  SimulationConfig config;
  config.robots = {fallingArm(R"(type="continuous">)", "")};
  for (const char* joint : {"shoulder", "elbow"}) {
    config.robots[0].gains[joint].p = stiffness;
    config.robots[0].gains[joint].d = 5;
  }
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  Simulator simulator(config, model::UriResolver());
  constexpr int JUMPS = 10;
  double fastest = 0, out_of_nothing = 0;
  for (int i = 0; i < 200 * JUMPS; ++i) {
    const double target = i / 200 % 2 == 0 ? 1 : -1;
    if (i % 200 == 0) simulator.commandJoints(0, {{"shoulder", "elbow"}, {target, -2 * target}, {}, {}});
    out_of_nothing = std::max(out_of_nothing, simulator.step().energy_out_of_nothing);
    fastest = std::max(fastest, std::abs(simulator.world().jointState(1).velocity));
  }
  EXPECT_GT(fastest, 10) << stiffness;
  return out_of_nothing;
}

/**
 * Motors without an effort limit; stiff joints keep their velocity on the free way, and pay in the next step. What is gained most is gained
 * in the last fast and first slow steps of a throw, and differs by a factor of three with where they fall.
 */
TEST(EnergyOutOfNothing, IsHardlyAnyWhereMotorsThrowAnArmAbout) {
  constexpr double STIFFNESSES[] = {280, 290, 295, 298, 299, 300, 301, 302, 305, 310, 320, 340};  // [N m/rad]
  double sum = 0;
  for (const double stiffness : STIFFNESSES) sum += mostWhereMotorsThrowAnArm(stiffness);
  EXPECT_LT(sum / std::size(STIFFNESSES), 3e-6);
}

TEST(EnergyGainedBit, IsNotSetByWhatContactsDoOnPurpose) {
  const Vector3 size = Vector3::Constant(0.1);
  EXPECT_EQ(statusOf(onGround({box("deep", size, 1, {0, 0, 0.0515})}), 0.3) & ENERGY_GAINED, 0u);
  const std::uint32_t crossed = statusOf(onGround({box("crossed", size, 1, {0, 0, 0.0485})}), 0.3);
  EXPECT_NE(crossed & CONTACT_UNRELIABLE, 0u);
  EXPECT_EQ(crossed & ENERGY_GAINED, 0u);
}

TEST(EnergyGainedBit, IsNotSetByABounceOfABall) {
  SimulationConfig config = onGround({});
  config.robots = {robot("ball", R"(<robot name="ball"><link name="link"><inertial><mass value="1"/>
    <inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.05"/></geometry></collision></link></robot>)",
                         false)};
  config.robots[0].X_WR = makePose({0, 0, 0.3});
  for (const double restitution : {0.5, 1.0}) {
    config.contact.surface.restitution = restitution;
    EXPECT_EQ(statusOf(config, 1) & ENERGY_GAINED, 0u) << restitution;
  }
}

TEST(EnergyGainedBit, IsNotSetByMotorsFrictionAndLimits) {
  SimulationConfig config;
  config.robots = {robot("pendulum", pendulumUrdf(R"(<dynamics damping="0.1" friction="0.5"/>)"), true)};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  for (const double stiffness : {1.0, 100.0, 1e5}) {
    config.robots[0].gains["default"] = {stiffness, 0, 0.05 * stiffness};
    EXPECT_EQ(statusOf(config, 1, {{"hinge"}, {-1}, {}, {}}) & ENERGY_GAINED, 0u) << stiffness;
  }
  EXPECT_EQ(statusOf(config, 1, {{"hinge"}, {3}, {}, {}}) & ENERGY_GAINED, 0u);
}

}  // namespace
}  // namespace blem_sim::sim
