// Forces on cylinders that stand, lean, spin and are pressed, against closed forms.
#include <algorithm>
#include <cmath>

#include "sim/cylinder_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double LAYER_OF_CAN = 0.001;  // [m]
constexpr double OUTER = 0.05;          // [m]
const SolidCylinder CAN{OUTER, 0.2, 2};

/** [N] Upward force of fixed surfaces at places from y_low to y_high. */
double forceBetween(const StepReport& report, double y_low, double y_high) {
  double force = 0;
  for (const ContactReport& contact : report.contacts)
    if (contact.point.y() >= y_low && contact.point.y() < y_high)
      force += (contact.body_a == dynamics::WORLD_BODY ? -1 : 1) * contact.force.z();
  return force;
}

/** Rims of a can whose centre of mass is off the middle bear it as levers say. */
TEST(CylinderLoads, RimsShareAWeightThatIsOffTheMiddle) {
  constexpr double OFF = 0.06;
  SimulationConfig config = roundConfig(0.5, LAYER_OF_CAN);
  config.environments = {level()};
  config.objects = {cylinderAlongY("can", CAN, {0, 0, OUTER}, OFF)};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.2);
  const double weight = CAN.mass * G, share = OFF / CAN.core(LAYER_OF_CAN).length;
  EXPECT_NEAR(forceBetween(simulator.report(), 0, 1), weight * (0.5 + share), 1e-6 * weight);
  EXPECT_NEAR(forceBetween(simulator.report(), -1, 0), weight * (0.5 - share), 1e-6 * weight);
}

/** A log across two fixed ones, at unequal distances. */
TEST(CylinderLoads, CrossedLogsShareAWeightByLevers) {
  constexpr double LEFT = -0.03, RIGHT = 0.07;
  const SolidCylinder below{0.03, 0.4, 1};
  const auto beam = [&](const char* name, double y) {
    return jointedText(name, "fixed", fmt::format(R"(xyz="0 {} 0" rpy="0 1.5707963267948966 0")", y), "0 0 1", cylinderText(below));
  };
  SimulationConfig config = roundConfig(0.5, LAYER_OF_CAN);
  config.robots = {machine("beams", beam("left", LEFT) + beam("right", RIGHT))};
  config.objects = {cylinderAlongY("can", CAN, {0, 0, OUTER + 0.03})};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.2);
  const double weight = CAN.mass * G;
  EXPECT_NEAR(forceBetween(simulator.report(), -1, 0), weight * RIGHT / (RIGHT - LEFT), 1e-6 * weight);
  EXPECT_NEAR(forceBetween(simulator.report(), 0, 1), -weight * LEFT / (RIGHT - LEFT), 1e-6 * weight);
  EXPECT_NEAR(bodyOf(simulator, "can").X_WB.translation().z(), OUTER + 0.03, 1e-7);
}

/** A pad that is pressed by a force against a shaft of 1,000 rad/s: friction times force times radius. */
TEST(CylinderLoads, APadBrakesAShaft) {
  constexpr double FORCE = 40, FRICTION = 0.3, SPIN = 1000;
  for (const double time_step : {1e-3, 5e-3}) {
    SimulationConfig config = roundConfig(FRICTION, LAYER_OF_CAN);
    config.time_step = time_step;
    config.gravity.setZero();
    config.robots = {machine("lathe", jointedText("shaft", "continuous", ALONG_Y, "0 0 1", cylinderText(CAN)) +
                                          jointedText("pad", "prismatic", R"(xyz="0 0 0.082")", "0 0 1", boxText({0.08, 0.1, 0.06}, 0.5)))};
    config.robots[0].self_collision = true;
    Simulator simulator(config, model::UriResolver());
    const int shaft = simulator.robots()[0].joints[0], pad = simulator.robots()[0].joints[1];
    simulator.applyEffort(shaft, SPIN * CAN.along() / 0.1, {0, 0.1});
    stepFor(&simulator, 0.1);
    const double spin = simulator.world().jointState(shaft).velocity;
    EXPECT_NEAR(spin, SPIN, 1e-3 * SPIN);
    simulator.applyEffort(pad, -FORCE, {0, -1});
    stepFor(&simulator, 0.3);
    const double theory = FRICTION * FORCE * OUTER / CAN.along() * 0.3;
    EXPECT_NEAR(spin - simulator.world().jointState(shaft).velocity, theory, 1e-4 * theory) << time_step;
    EXPECT_NEAR(simulator.world().jointState(pad).position, -0.001, 1e-5) << time_step;
    stepFor(&simulator, 1.5 * spin * CAN.along() / (FRICTION * FORCE * OUTER));
    EXPECT_NEAR(simulator.world().jointState(shaft).velocity, 0, 1e-6) << time_step;
  }
}

/** A wheel that a force presses against a wall, turned by a motor: beyond friction it spins up by what is left. */
TEST(CylinderLoads, AMotorTurnsAWheelAgainstAWall) {
  constexpr double FORCE = 30, FRICTION = 0.5;
  for (const double torque : {0.5, 0.9}) {
    SimulationConfig config = roundConfig(FRICTION, LAYER_OF_CAN);
    config.gravity.setZero();
    config.environments = {block("wall", {0.2, 2, 2}, {0.1 + OUTER, 0, 1})};
    const std::string wheel = fmt::format(R"(<link name="wheel">{}</link><joint name="turn" type="continuous"><parent link="slide"/>)"
                                          R"(<child link="wheel"/><origin {}/><axis xyz="0 0 1"/></joint>)",
                                          cylinderText(CAN), ALONG_Y);
    config.robots = {machine("press", jointedText("slide", "prismatic", "", "1 0 0", boxText({0.01, 0.01, 0.01}, 0.3)) + wheel)};
    Simulator simulator(config, model::UriResolver());
    const RobotInfo& press = simulator.robots()[0];
    simulator.applyEffort(press.joints[0], FORCE, {0, -1});
    simulator.applyEffort(press.joints[1], torque, {0, -1});
    stepFor(&simulator, 0.5);
    const double left = std::max(0.0, torque - FRICTION * FORCE * OUTER);
    EXPECT_NEAR(simulator.world().jointState(press.joints[1]).velocity, left / CAN.along() * 0.5, 1e-3) << torque;
    const Vector3 force = forceOfWorld(simulator.report());
    EXPECT_NEAR(force.x(), -FORCE, 1e-3) << torque;
    EXPECT_NEAR(std::abs(force.z()), std::min(torque / OUTER, FRICTION * FORCE), 1e-3) << torque;
  }
}

/** Euler's disk: its middle stays, its rim rolls on a circle at a rate of 4 g / (r sin lean) [Moffatt 2000], thick as it is. */
TEST(CylinderLoads, ACoinOnItsRimWobblesWithoutLoss) {
  const SolidCylinder coin{0.05, 0.002, 1};
  constexpr double LEAN = 0.25, THIN = 1e-4;
  SimulationConfig config = roundConfig(3, THIN);
  config.environments = {level()};
  const SolidCylinder core = coin.core(THIN);
  const double half = core.length / 2, below = core.radius * std::sin(LEAN) + half * std::cos(LEAN) + THIN;
  const double beside = core.radius * std::cos(LEAN) - half * std::sin(LEAN);
  // The middle stays, so the spin is along the radius to the contact; its moment is the change of momentum.
  const Vector3 axis(std::sin(LEAN), 0, std::cos(LEAN)), arm(beside, 0, -below);
  const Vector3 along_arm = arm.normalized();
  const Vector3 momentum = coin.across() * along_arm + (coin.along() - coin.across()) * along_arm.dot(axis) * axis;
  // spin = s along_arm; the axis turns about z at the rate that keeps it at its lean.
  const double rate_of_spin = along_arm.cross(axis).y() / axis.x();  // of the turn about z, per s: w x axis = rate z x axis
  const double spin = std::sqrt(coin.mass * G * arm.x() / -(Vector3::UnitZ().cross(momentum).y() * rate_of_spin));
  config.objects = {cylinderAlongY("coin", coin, {0, 0, below})};
  config.objects[0].X_WO = makePose({0, 0, below}, {0, LEAN, 0});
  config.objects[0].angular_velocity = spin * along_arm;
  Simulator simulator(config, model::UriResolver());
  const double energy = simulator.world().kineticEnergy();
  double lowest = 1, highest = 0, off = 0;
  for (int i = 0; i < 1000; ++i) {
    simulator.step();
    const Vector3 p = bodyOf(simulator, "coin").X_WB.translation();
    lowest = std::min(lowest, p.z());
    highest = std::max(highest, p.z());
    off = std::max(off, p.head<2>().norm());
  }
  EXPECT_LT(highest - lowest, 1e-4);
  EXPECT_LT(off, 1e-4);
  EXPECT_NEAR(simulator.world().kineticEnergy() / energy, 1, 5e-3);
}

/** A pencil on its flat end stands if its middle is over the end, else it falls. */
TEST(CylinderLoads, APencilStandsOnItsEndUpToItsAngle) {
  const SolidCylinder pencil{0.0035, 0.175, 0.006};
  constexpr double THIN = 1e-4;
  const SolidCylinder core = pencil.core(THIN);
  const double balance = std::atan2(core.radius, core.length / 2);
  for (const double part : {0.0, 0.9, 1.1}) {
    SimulationConfig config = roundConfig(0.6, THIN);
    config.environments = {level()};
    config.objects = {cylinderAlongY("pencil", pencil, {0, 0, 0})};
    const double lean = part * balance;
    config.objects[0].X_WO = makePose({0, 0, core.length / 2 * std::cos(lean) + core.radius * std::sin(lean) + THIN}, {0, lean, 0});
    Simulator simulator(config, model::UriResolver());
    stepFor(&simulator, 2);
    const double upright = bodyOf(simulator, "pencil").X_WB.linear()(2, 2);
    EXPECT_NEAR(upright, part < 1 ? 1 : 0, 1e-3) << part;
  }
}

/** Fingers that close on a can, upright and lying along them: it falls by what friction leaves of its weight. */
TEST(CylinderLoads, FingersHoldACanAsFrictionLetsThem) {
  constexpr double FRICTION = 0.4;
  const Vector3 plate(0.04, 0.3, 0.5);
  for (const bool upright : {false, true})
    for (const double share : {0.45, 0.55}) {  // of the weight, on each finger
      SimulationConfig config = roundConfig(FRICTION, LAYER_OF_CAN);
      const double apart = OUTER + plate.x() / 2 + LAYER_OF_CAN, force = share * CAN.mass * G / FRICTION;
      const auto finger = [&](const char* name, double x) {
        return jointedText(name, "prismatic", fmt::format(R"(xyz="{} 0 0")", x), x < 0 ? "1 0 0" : "-1 0 0", boxText(plate, 0.2));
      };
      config.robots = {machine("hand", finger("left", -apart) + finger("right", apart))};
      config.objects = {cylinderAlongY("can", CAN, {0, 0, 0})};
      if (upright) config.objects[0].X_WO = Pose::Identity();
      Simulator simulator(config, model::UriResolver());
      for (const int joint : simulator.robots()[0].joints) simulator.applyEffort(joint, force, {0, -1});
      stepFor(&simulator, 0.05);
      const double start = bodyOf(simulator, "can").v_WCom.z();
      stepFor(&simulator, 0.1);
      const double falls = std::max(0.0, 1 - 2 * share) * G * 0.1;
      EXPECT_NEAR(start - bodyOf(simulator, "can").v_WCom.z(), falls, 1e-4) << upright << " " << share;
      EXPECT_NEAR(bodyOf(simulator, "can").w_WB.norm(), 0, 1e-4) << upright << " " << share;
    }
}

/** A coin whose end lies down within a step as its rim hits the ground: no part of it goes below. */
TEST(CylinderLoads, ACoinThatSlapsDownStopsOnTheGround) {
  const SolidCylinder coin{0.01, 0.002, 0.005};
  constexpr double THIN = 2e-4;
  for (const double lean : {0.06, 0.11, 0.2})
    for (const double speed : {1.0, 4.0, 8.0}) {
      SimulationConfig config = roundConfig(0, THIN);
      config.environments = {level()};
      config.objects = {cylinderAlongY("coin", coin, {0, 0, 0})};
      config.objects[0].X_WO = makePose({0, 0, 0.008}, {0, lean, 0});
      config.objects[0].linear_velocity = {0, 0, -speed};
      Simulator simulator(config, model::UriResolver());
      double lowest = 1;
      for (int i = 0; i < 30; ++i) {
        simulator.step();
        const Pose X = bodyOf(simulator, "coin").X_WB;
        const double upright = X.linear()(2, 2);
        lowest = std::min(lowest, X.translation().z() - 0.5 * coin.length * std::abs(upright) -
                                      coin.radius * std::sqrt(std::max(0.0, 1 - upright * upright)));
      }
      EXPECT_GT(lowest, -THIN) << lean << " " << speed;
    }
}

/** A coin that slides and spins flat on its rim: slides mu g where it does not spin. */
TEST(CylinderLoads, ACoinThatSpinsFlatIsBrakedByItsRim) {
  const SolidCylinder coin{0.05, 0.01, 1};
  constexpr double FRICTION = 0.2, SPIN = 50;
  SimulationConfig config = roundConfig(FRICTION, 1e-4);
  config.environments = {level()};
  config.objects = {cylinderAlongY("coin", coin, {0, 0, 0})};
  config.objects[0].X_WO = makePose({0, 0, coin.length / 2});
  config.objects[0].angular_velocity = {0, 0, SPIN};
  Simulator simulator(config, model::UriResolver());
  stepFor(&simulator, 0.2);
  const double theory = FRICTION * coin.mass * G * coin.core(1e-4).radius / coin.along() * 0.2;
  EXPECT_NEAR(SPIN - bodyOf(simulator, "coin").w_WB.z(), theory, 1e-3 * theory);
}

}  // namespace
}  // namespace blem_sim::sim
