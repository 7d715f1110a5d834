// Balls and tops that spin while they roll, against closed forms of motion without slip.
#include <algorithm>
#include <cmath>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double ROLLER = 0.1;  // [m] radius
const Vector3 UP(0, 0, ROLLER);

SimulationConfig roughPlane(double friction) {
  SimulationConfig config;
  config.contact.surface.friction = friction;
  EnvironmentConfig plane;
  plane.name = "plane";
  plane.plane = Eigen::Vector4d(0, 0, 1, 0);
  config.environments.push_back(plane);
  return config;
}

/** Ball of 1 kg, its principal inertias along its axes, that begins to roll without slip at a spin. */
ObjectConfig rollingBall(const Vector3& inertia, const Vector3& spin) {
  ObjectConfig ball;
  ball.name = "ball";
  ball.urdf_xml = fmt::format(
      "<robot name='ball'><link name='ball'><inertial><mass value='1'/><inertia ixx='{}' iyy='{}' izz='{}' ixy='0' ixz='0' iyz='0'/>"
      "</inertial><collision><geometry><sphere radius='{}'/></geometry></collision></link></robot>",
      inertia.x(), inertia.y(), inertia.z(), ROLLER);
  ball.X_WO = makePose(UP, {0.3, 0.5, 0.2});
  ball.angular_velocity = spin;
  ball.linear_velocity = spin.cross(UP);
  return ball;
}

TEST(Rolling, ABallThatSpinsAboutTheNormalGoesStraight) {
  SimulationConfig config = roughPlane(1);
  config.objects.push_back(rollingBall(Vector3::Constant(0.004), {0, 20, 50}));
  Simulator simulator(config, model::UriResolver());
  double worst = 0;
  for (int i = 0; i < 500; ++i) {
    simulator.step();
    worst = std::max(worst, (forceOfWorld(simulator.report()) - Vector3(0, 0, G)).norm());
  }
  const dynamics::BodyState ball = bodyOf(simulator, "ball");
  EXPECT_LT(worst, 1e-6);
  EXPECT_NEAR(ball.X_WB.translation().y(), 0, 1e-9);
  EXPECT_LT((ball.v_WCom - Vector3(2, 0, 0)).norm(), 1e-9);
  EXPECT_LT((ball.w_WB - Vector3(0, 20, 50)).norm(), 1e-7);
}

/** [kg m^2/s] Angular momentum about the point of contact, which rolling without slip keeps. */
Vector3 momentumAtContact(const dynamics::BodyState& ball, const Vector3& inertia) {
  const Matrix3 R = ball.X_WB.linear();
  return R * inertia.asDiagonal() * R.transpose() * ball.w_WB + UP.cross(ball.v_WCom);
}

// Chaplygin's ball [1903].
TEST(Rolling, ABallOfUnequalInertiasKeepsItsEnergy) {
  const Vector3 inertia(0.0025, 0.004, 0.0055);
  for (const double speed : {3, 10, 30}) {
    SimulationConfig config = roughPlane(50);
    config.objects.push_back(rollingBall(inertia, speed * Vector3(0.03, 0.92, 0.38)));
    Simulator simulator(config, model::UriResolver());
    const double energy = simulator.world().kineticEnergy();
    const Vector3 momentum = momentumAtContact(bodyOf(simulator, "ball"), inertia);
    for (int i = 0; i < 2000; ++i) {
      simulator.step();
      ASSERT_NEAR(simulator.world().kineticEnergy(), energy, 3e-5 * energy) << speed << " rad/s, step " << i;
    }
    EXPECT_LT((momentumAtContact(bodyOf(simulator, "ball"), inertia) - momentum).norm(), 1e-4 * momentum.norm()) << speed;
  }
}

// A rotor on a hinge in a ball turns it as it rolls.
TEST(Rolling, ABallWithAGyroscopeKeepsItsEnergy) {
  SimulationConfig config = roughPlane(50);
  RobotConfig ball = robot("ball", R"(<robot name="ball">
    <link name="shell"><inertial><mass value="0.6"/><inertia ixx="0.003" iyy="0.003" izz="0.003" ixy="0" ixz="0" iyz="0"/></inertial>
      <collision><geometry><sphere radius="0.1"/></geometry></collision></link>
    <link name="rotor"><inertial><mass value="0.4"/><inertia ixx="2e-4" iyy="2e-4" izz="4e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="hinge" type="continuous"><parent link="shell"/><child link="rotor"/><axis xyz="0 0 1"/></joint></robot>)",
                           false);
  ball.X_WR = makePose(UP, {0.9, 0, 0});
  config.robots.push_back(ball);
  Simulator simulator(config, model::UriResolver());
  simulator.commandJoints(0, {{"hinge"}, {}, {}, {0.4}});
  stepFor(&simulator, 0.2);
  simulator.commandJoints(0, {{"hinge"}, {}, {}, {0}});
  simulator.step();
  const double energy = simulator.world().kineticEnergy();
  ASSERT_GT(energy, 5);
  for (int i = 0; i < 2000; ++i) {
    simulator.step();
    ASSERT_NEAR(simulator.world().kineticEnergy(), energy, 1e-4 * energy) << "step " << i;
  }
}

// Without slip a ball's velocity turns at 2/7 of the table's speed [Milne 1948].
TEST(Rolling, ABallOnATurntableTurnsBySevenths) {
  constexpr double TURNS = 10, FAR = 0.3, SPEED = 1.2;  // [rad/s], [m], [m/s]
  SimulationConfig config;
  config.contact.surface.friction = 2;
  const std::string table = meshFile("turntable", geometry::cylinderMesh(3, 0.02, 64));
  RobotConfig turntable = robot("table",
                                fmt::format(R"(<robot name="table"><link name="stand"/><link name="disc">
    <inertial><mass value="10"/><inertia ixx="10" iyy="10" izz="10" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><mesh filename="file://{}"/></geometry></collision></link>
    <joint name="turn" type="continuous"><parent link="stand"/><child link="disc"/><axis xyz="0 0 1"/></joint></robot>)",
                                            table),
                                true);
  turntable.X_WR = makePose({0, 0, -0.015});
  turntable.motors = MotorDefault::COMPUTED;
  config.robots.push_back(turntable);
  ObjectConfig ball = rollingBall(Vector3::Constant(0.004), Vector3::Zero());
  ball.X_WO = makePose({FAR, 0, ROLLER});
  ball.linear_velocity = {0, SPEED, 0};
  ball.angular_velocity = Vector3::UnitZ().cross(ball.linear_velocity - Vector3(0, TURNS * FAR, 0)) / ROLLER;
  config.objects.push_back(ball);
  Simulator simulator(config, model::UriResolver());
  simulator.commandJoints(0, {{"turn"}, {}, {TURNS}, {}});
  stepFor(&simulator, 0.5);
  Vector3 last = bodyOf(simulator, "ball").v_WCom;
  double angle = 0, slowest = last.norm(), fastest = slowest;
  for (int i = 0; i < 1000; ++i) {
    simulator.step();
    const Vector3 v = bodyOf(simulator, "ball").v_WCom;
    angle += std::atan2(last.cross(v).z(), last.dot(v));
    slowest = std::min(slowest, v.norm());
    fastest = std::max(fastest, v.norm());
    last = v;
  }
  EXPECT_NEAR(angle, 2.0 / 7 * TURNS, 1e-3);
  EXPECT_LT(fastest, 1.001 * slowest);
}

/** Largest and least tilt of a top's axis, and how far it went about the vertical. */
struct Precession {
  double least, largest, angle;  ///< [rad]
};

Precession precess(Simulator* simulator, int steps) {
  Precession seen{M_PI, 0, 0};
  Vector3 last = bodyOf(*simulator, "top").X_WB.linear().col(2);
  for (int i = 0; i < steps; ++i) {
    simulator->step();
    const Vector3 axis = bodyOf(*simulator, "top").X_WB.linear().col(2);
    seen.angle += std::remainder(std::atan2(axis.y(), axis.x()) - std::atan2(last.y(), last.x()), 2 * M_PI);
    seen.least = std::min(seen.least, std::acos(axis.z()));
    seen.largest = std::max(seen.largest, std::acos(axis.z()));
    last = axis;
  }
  return seen;
}

// A round tip rolls: m g l / (I_3 w) while the axis nods by less than 0.03 rad, as it does with steps of a tenth of the time.
TEST(Rolling, ATopPrecessesWithoutNoddingMoreAndMore) {
  constexpr double SPIN = 200, LENGTH = 0.05, AXIAL = 5e-5, MASS = 0.1;
  SimulationConfig config = roughPlane(0.3);
  ObjectConfig top;
  top.name = "top";
  top.urdf_xml = fmt::format(
      "<robot name='top'><link name='top'><inertial><mass value='{}'/><inertia ixx='1.5e-4' iyy='1.5e-4' izz='{}' ixy='0' ixz='0' iyz='0'/>"
      "</inertial><collision><origin xyz='0 0 -{}'/><geometry><sphere radius='0.002'/></geometry></collision></link></robot>",
      MASS, AXIAL, LENGTH);
  top.X_WO = makePose({0, 0, LENGTH * std::cos(0.3) + 0.002}, {0.3, 0, 0});
  top.angular_velocity = SPIN * top.X_WO.linear().col(2);
  config.objects.push_back(top);
  Simulator simulator(config, model::UriResolver());
  const double energy = simulator.report().energy;
  const Precession seen = precess(&simulator, 2000);
  EXPECT_NEAR(seen.angle, 2 * MASS * G * LENGTH / (AXIAL * SPIN), 0.05);
  EXPECT_GT(seen.least, 0.28);
  EXPECT_LT(seen.largest, 0.33);
  EXPECT_LT(simulator.report().energy, energy);
}

}  // namespace
}  // namespace blem_sim::sim
