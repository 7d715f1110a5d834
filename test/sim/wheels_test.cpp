// Wheels, logs and coins: URDF cylinders that roll, against closed forms.
#include <algorithm>
#include <cmath>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double WHEEL = 0.05, WHEEL_MASS = 0.2, CHASSIS_MASS = 4;  // [m], [kg]
constexpr double WHEEL_INERTIA = 0.5 * WHEEL_MASS * WHEEL * WHEEL;

std::string inertial(double mass, const Vector3& inertia) {
  return fmt::format(R"(<inertial><mass value="{}"/><inertia ixx="{}" iyy="{}" izz="{}" ixy="0" ixz="0" iyz="0"/></inertial>)", mass,
                     inertia.x(), inertia.y(), inertia.z());
}

std::string cylinder(double radius, double length) {
  return fmt::format(R"(<collision><geometry><cylinder radius="{}" length="{}"/></geometry></collision>)", radius, length);
}

/** A chassis on four wheels whose joints move freely; x is ahead. */
RobotConfig cart() {
  std::string urdf = "<robot name=\"cart\"><link name=\"chassis\">" + inertial(CHASSIS_MASS, {0.02, 0.05, 0.07}) + "</link>";
  for (const double x : {-0.15, 0.15})
    for (const double y : {-0.13, 0.13}) {
      const std::string name = fmt::format("wheel{}{}", x > 0 ? "front" : "rear", y > 0 ? "left" : "right");
      urdf += fmt::format(R"(<link name="{0}">{1}{2}</link><joint name="of_{0}" type="continuous"><parent link="chassis"/>
          <child link="{0}"/><origin xyz="{3} {4} 0" rpy="-1.5707963267948966 0 0"/><axis xyz="0 0 1"/></joint>)",
                          name, inertial(WHEEL_MASS, Vector3::Constant(WHEEL_INERTIA)), cylinder(WHEEL, 0.03), x, y);
    }
  RobotConfig config = robot("cart", urdf + "</robot>", false);
  config.X_WR = makePose({-1.5, 0, WHEEL});
  return config;
}

EnvironmentConfig tiles() {
  EnvironmentConfig environment;
  environment.name = "tiles";
  environment.uri = meshFile("tiles", geometry::gridMesh(8, 2, 80, 20));
  return environment;
}

EnvironmentConfig plane() {
  EnvironmentConfig environment;
  environment.name = "plane";
  environment.plane = Eigen::Vector4d(0, 0, 1, 0);
  return environment;
}

TEST(Wheels, ACartRollsDownASlopeAsItsInertiaLetsIt) {
  constexpr double SLOPE = 0.2;
  for (const EnvironmentConfig& ground : {plane(), tiles()}) {
    SimulationConfig config;
    config.gravity = G * Vector3(std::sin(SLOPE), 0, -std::cos(SLOPE));
    config.environments = {ground};
    config.robots = {cart()};
    Simulator simulator(config, model::UriResolver());
    for (int i = 0; i < 200; ++i) simulator.step();
    const dynamics::BodyState before = bodyOf(simulator, "cart");
    double lowest = 1, highest = 0;
    for (int i = 0; i < 1000; ++i) {
      simulator.step();
      const double height = bodyOf(simulator, "cart").X_WB.translation().z();
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
    const double mass = CHASSIS_MASS + 4 * WHEEL_MASS;
    const double theory = mass * G * std::sin(SLOPE) / (mass + 4 * WHEEL_INERTIA / (WHEEL * WHEEL));
    const dynamics::BodyState after = bodyOf(simulator, "cart");
    EXPECT_NEAR(after.v_WCom.x() - before.v_WCom.x(), theory, 1e-8) << ground.name;
    EXPECT_NEAR(after.X_WB.translation().y(), 0, 1e-9) << ground.name;
    EXPECT_LT(highest - lowest, 1e-8) << ground.name;
  }
}

/** At steps of 5 ms the wheels turn by 2 rad in one. */
TEST(Wheels, WheelsThatSpinPushAsFrictionLetsThem) {
  for (const double time_step : {1e-3, 5e-3})
    for (const EnvironmentConfig& ground : {plane(), tiles()}) {
      SimulationConfig config;
      config.time_step = time_step;
      config.contact.surface.friction = 0.8;
      config.environments = {ground};
      config.robots = {cart()};
      config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
      config.robots[0].gains["default"] = {0, 0, 2};
      Simulator simulator(config, model::UriResolver());
      simulator.commandJoints(0, {simulator.robots()[0].joint_names, {}, {400, 400, 400, 400}, {}});
      const long steps = std::lround(0.5 / time_step);
      for (long i = 0; i < steps; ++i) simulator.step();
      const dynamics::BodyState after = bodyOf(simulator, "cart");
      EXPECT_NEAR(after.v_WCom.x(), 0.8 * G * 0.5, 1e-5) << time_step << " " << ground.name;
      EXPECT_NEAR(after.X_WB.translation().z(), WHEEL, 1e-6) << time_step << " " << ground.name;
    }
}

/** A log of 1 kg that lies on the plane, along y. */
ObjectConfig lyingLog(double length) {
  ObjectConfig log;
  log.name = "log";
  const double along = 0.5 * WHEEL * WHEEL, across = (3 * WHEEL * WHEEL + length * length) / 12;
  log.urdf_xml = "<robot name='log'><link name='log'>" + inertial(1, {across, across, along}) + cylinder(WHEEL, length) + "</link></robot>";
  log.X_WO = makePose({0, 0, WHEEL}, {-M_PI / 2, 0, 0});
  return log;
}

TEST(Wheels, ALogThatSlidesEndsUpRolling) {
  for (const double time_step : {1e-3, 5e-3}) {
    SimulationConfig config;
    config.time_step = time_step;
    config.contact.surface.friction = 0.4;
    config.environments = {plane()};
    config.objects = {lyingLog(0.1)};
    config.objects[0].linear_velocity = {2, 0, 0};
    Simulator simulator(config, model::UriResolver());
    for (int i = 0; i < std::lround(1 / time_step); ++i) simulator.step();
    EXPECT_NEAR(bodyOf(simulator, "log").v_WCom.x(), 2 / 1.5, 1e-6) << time_step;
  }
}

TEST(Wheels, ALogThatSpinsBouncesAsItsRestitutionSays) {
  constexpr double DROP = 0.25, RESTITUTION = 0.5;
  SimulationConfig config;
  config.contact.surface.restitution = RESTITUTION;
  config.contact.surface.friction = 0;
  config.environments = {plane()};
  config.objects = {lyingLog(0.1)};
  config.objects[0].X_WO.translation().z() += DROP;
  config.objects[0].angular_velocity = {0, 40, 0};
  Simulator simulator(config, model::UriResolver());
  const int fall = static_cast<int>(std::sqrt(2 * DROP / G) / 1e-3);
  double apex = 0;
  for (int i = 0; i < 2 * fall; ++i) {
    simulator.step();
    if (i > fall + 5) apex = std::max(apex, bodyOf(simulator, "log").X_WB.translation().z() - WHEEL);
  }
  EXPECT_NEAR(apex / DROP, RESTITUTION * RESTITUTION, 1e-4);
  EXPECT_NEAR((bodyOf(simulator, "log").w_WB - Vector3(0, 40, 0)).norm(), 0, 1e-6);
}

TEST(Wheels, ALogThatLiesOnTwoRollersTurnsAgainstThem) {
  constexpr double LOG = 0.04, APART = 0.06, SPEED = 5;
  std::string urdf = "<robot name=\"rollers\"><link name=\"frame\"/>";
  for (const double x : {-APART, APART})
    urdf += fmt::format(R"(<link name="roller{0}">{1}{2}</link><joint name="of_roller{0}" type="continuous"><parent link="frame"/>
        <child link="roller{0}"/><origin xyz="{0} 0 0" rpy="-1.5707963267948966 0 0"/><axis xyz="0 0 1"/></joint>)",
                        x, inertial(1, Vector3::Constant(0.001)), cylinder(WHEEL, 0.3));
  SimulationConfig config;
  config.robots = {robot("rollers", urdf + "</robot>", true)};
  config.robots[0].motor["default"] = MotorLaw::IMPLICIT_PD;
  config.robots[0].gains["default"] = {0, 0, 10};
  const double reach = WHEEL + LOG, height = std::sqrt(reach * reach - APART * APART);
  ObjectConfig log;
  log.name = "log";
  log.urdf_xml = "<robot name='log'><link name='log'>" + inertial(1, {0.004, 0.004, 0.0008}) + cylinder(LOG, 0.2) + "</link></robot>";
  log.X_WO = makePose({0, 0.02, height}, {-M_PI / 2, 0, 0});
  config.objects = {log};
  Simulator simulator(config, model::UriResolver());
  simulator.commandJoints(0, {simulator.robots()[0].joint_names, {}, {SPEED, SPEED}, {}});
  for (int i = 0; i < 1000; ++i) simulator.step();
  double off = 0;
  for (int i = 0; i < 1000; ++i) {
    simulator.step();
    off = std::max(off, (bodyOf(simulator, "log").X_WB.translation() - Vector3(0, 0.02, height)).norm());
  }
  EXPECT_LT(off, 1e-6);
  const Vector3 spin = bodyOf(simulator, "log").w_WB;
  EXPECT_NEAR((spin + SPEED * WHEEL / LOG * Vector3::UnitY()).norm(), 0, 1e-6);
}

/** A coin of 1 kg that leans by 0.3 rad to the left and rolls on a circle about the origin. */
struct RollingCoin {
  static constexpr double RADIUS = 0.05, LENGTH = 0.002, LAYER = 0.0005, LEAN = 0.3, CIRCLE = 0.3;               // [m], [rad]
  static constexpr double ALONG = 0.5 * RADIUS * RADIUS, ACROSS = (3 * RADIUS * RADIUS + LENGTH * LENGTH) / 12;  // [kg m^2]
  double height = 0;                                                                                             // [m] of its middle
  Vector3 velocity, spin;
  Matrix3 R_WC;

  /** Of the motion that stays: the contact's moment turns the angular momentum with the coin, [Landau 1976, par. 38]. */
  RollingCoin() {
    const Vector3 inwards = Vector3::UnitY(), up = Vector3::UnitZ(), ahead = Vector3::UnitX();
    const Vector3 axis = std::cos(LEAN) * inwards - std::sin(LEAN) * up;
    const Vector3 arm = (LAYER - RADIUS) * (std::sin(LEAN) * inwards + std::cos(LEAN) * up) + (0.5 * LENGTH - LAYER) * axis - LAYER * up;
    const double rate = -(CIRCLE + up.cross(arm).x()) / axis.cross(arm).x();  // spin about the axis over that about the vertical
    const Vector3 spin_1 = up + rate * axis;
    const Vector3 momentum_1 = ACROSS * spin_1 + (ALONG - ACROSS) * spin_1.dot(axis) * axis;
    // (omega^2) up x momentum_1 = arm x (omega^2 circle inwards + g up), along x
    const double omega = std::sqrt(G * arm.cross(up).x() / (up.cross(momentum_1) - arm.cross(CIRCLE * inwards)).x());
    height = -arm.z();
    velocity = omega * CIRCLE * ahead;
    spin = omega * spin_1;
    R_WC << ahead, axis.cross(ahead), axis;
  }

  /** [J] */
  double energy(const dynamics::BodyState& coin) const {
    const Vector3 w = coin.X_WB.linear().transpose() * coin.w_WB;
    return G * coin.X_WB.translation().z() + 0.5 * coin.v_WCom.squaredNorm() + 0.5 * w.dot(Vector3(ACROSS, ACROSS, ALONG).cwiseProduct(w));
  }

  ObjectConfig object() const {
    ObjectConfig coin;
    coin.name = "coin";
    coin.urdf_xml =
        "<robot name='coin'><link name='coin'>" + inertial(1, {ACROSS, ACROSS, ALONG}) + cylinder(RADIUS, LENGTH) + "</link></robot>";
    coin.X_WO.translation() = Vector3(0, -CIRCLE, height);
    coin.X_WO.linear() = R_WC;
    coin.linear_velocity = velocity;
    coin.angular_velocity = spin;
    return coin;
  }
};

TEST(Wheels, ACoinThatLeansRollsOnACircle) {
  const RollingCoin rolling;
  SimulationConfig config;
  config.contact.surface.friction = 2;
  config.contact.boundary_width.metres = RollingCoin::LAYER;
  config.environments = {plane()};
  config.objects = {rolling.object()};
  Simulator simulator(config, model::UriResolver());
  const double start = rolling.energy(bodyOf(simulator, "coin"));
  double aside = 0, highest = 0, lowest = 1;
  for (int i = 0; i < 2500; ++i) {  // once round
    simulator.step();
    const Vector3 p = bodyOf(simulator, "coin").X_WB.translation();
    aside = std::max(aside, std::abs(p.head<2>().norm() - RollingCoin::CIRCLE));
    highest = std::max(highest, p.z());
    lowest = std::min(lowest, p.z());
  }
  EXPECT_LT(aside, 1e-3);
  EXPECT_LT(highest - lowest, 5e-5);
  EXPECT_NEAR(rolling.energy(bodyOf(simulator, "coin")) / start, 1, 5e-5);
}

}  // namespace
}  // namespace blem_sim::sim
