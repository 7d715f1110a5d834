// The benchmark bicycle of Meijaard, Papadopoulos, Ruina and Schwab 2007, whose leaning and steering theory tells to fourteen digits.
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "blem_sim/sim/named_parts.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double REAR = 0.3, FRONT = 0.35, WHEELBASE = 1.02, TRAIL = 0.08, TILT = M_PI / 10;  // [m], [m], [m], [m], [rad]
constexpr double SPEED = 5.8;                                                                 // [m/s]

/** A part of the bicycle. Its frame has x ahead and z up. */
struct Part {
  const char* name;
  double mass;        // [kg]
  Vector3 com;        // [m] in its frame
  double xx, yy, zz;  // [kg m^2]
  double xz, radius;  // [kg m^2], [m] of a wheel, 0: it is none
};

// Frame, fork, wheels. The fork's frame is where its axis meets the ground, the frame's where the rear wheel touches.
const Part PARTS[] = {{"frame", 85, {0.3, 0, 0.9}, 9.2, 11, 2.8, -2.4, 0},
                      {"fork", 4, {0.9 - WHEELBASE - TRAIL, 0, 0.7}, 0.05892, 0.06, 0.00708, 0.00756, 0},
                      {"rear", 2, {0, 0, 0}, 0.0603, 0.12, 0.0603, 0, REAR},
                      {"front", 3, {0, 0, 0}, 0.1405, 0.28, 0.1405, 0, FRONT}};

std::string linkOf(const Part& part) {
  const std::string rim = fmt::format(
      R"(<collision><origin rpy="1.5707963267948966 0 0"/><geometry><cylinder radius="{}" length="2e-5"/></geometry></collision>)",
      part.radius);
  return fmt::format(R"(<link name="{}"><inertial><origin xyz="{} 0 {}"/><mass value="{}"/>
      <inertia ixx="{}" iyy="{}" izz="{}" ixy="0" ixz="{}" iyz="0"/></inertial>{}</link>)",
                     part.name, part.com.x(), part.com.z(), part.mass, part.xx, part.yy, part.zz, part.xz, part.radius > 0 ? rim : "");
}

std::string hinge(const std::string& child, const std::string& parent, const Vector3& place, const Vector3& axis) {
  return fmt::format(R"(<joint name="of_{0}" type="continuous"><parent link="{1}"/><child link="{0}"/><origin xyz="{2} 0 {3}"/>
      <axis xyz="{4} {5} {6}"/></joint>)",
                     child, parent, place.x(), place.z(), axis.x(), axis.y(), axis.z());
}

std::string bicycleUrdf() {
  std::string urdf = "<robot name=\"bicycle\">";
  for (const Part& part : PARTS) urdf += linkOf(part);
  return urdf + hinge("rear", "frame", {0, 0, REAR}, Vector3::UnitY()) +
         hinge("fork", "frame", {WHEELBASE + TRAIL, 0, 0}, {-std::sin(TILT), 0, std::cos(TILT)}) +
         hinge("front", "fork", {-TRAIL, 0, FRONT}, Vector3::UnitY()) + "</robot>";
}

/** Whipple's equations, linear, as a first-order system of lean, steer and their rates; lean to the right, steer to the right. */
Eigen::Matrix4d whipple(double speed) {
  Eigen::Matrix2d m, k0, k2, c;
  m << 80.81722, 2.31941332208709, 2.31941332208709, 0.29784188199686;
  k0 << -80.95, -2.59951685249872, -2.59951685249872, -0.80329488458618;
  k2 << 0, 76.59734589573222, 0, 2.65431523794604;
  c << 0, 33.86641391492494, -0.85035641456978, 1.68540397397560;
  Eigen::Matrix4d system = Eigen::Matrix4d::Zero();
  system.topRightCorner<2, 2>().setIdentity();
  system.bottomLeftCorner<2, 2>() = -m.inverse() * (G * k0 + speed * speed * k2);
  system.bottomRightCorner<2, 2>() = -m.inverse() * speed * c;
  return system;
}

Eigen::Vector4d later(const Eigen::Matrix4d& system, const Eigen::Vector4d& state, double dt) {
  Eigen::Vector4d sum = state, term = state;
  for (int n = 1; n < 8; ++n) sum += term = dt / n * (system * term);
  return sum;
}

class Bicycle : public ::testing::Test {
 protected:
  Bicycle() : simulator(config(), model::UriResolver()) {
    for (const Part& part : PARTS)
      push(part.name, part.mass * SPEED / simulator.config().time_step * Vector3::UnitX(), part.com, simulator.config().time_step);
    turn("of_rear", 0.12 / REAR);
    turn("of_front", 0.28 / FRONT);
    simulator.step();
    push("frame", {0, 300, 0}, PARTS[0].com, 0.05);
  }

  static SimulationConfig config() {
    SimulationConfig config;
    config.contact.surface.friction = 2;
    config.contact.boundary_width = 1e-5;
    EnvironmentConfig plane;
    plane.name = "ground";
    plane.plane = Eigen::Vector4d(0, 0, 1, 0);
    config.environments = {plane};
    config.robots = {robot("bicycle", bicycleUrdf(), false)};
    return config;
  }

  void push(const std::string& link, const Vector3& force, const Vector3& point, double seconds) {
    BodyLoad load;
    load.body = findLink(simulator, "bicycle::" + link, "part").body;
    load.wrench.force = force;
    load.p_B = point;
    simulator.applyLoad(load, {0, seconds});
  }

  /** Gives a wheel the spin that it rolls with. @param inertia over the radius [kg m] */
  void turn(const std::string& joint, double inertia) {
    simulator.applyEffort(jointOf(joint), inertia * SPEED / simulator.config().time_step, {0, simulator.config().time_step});
  }

  int jointOf(const std::string& name) const {
    return simulator.robots()[0].joints[findJoint(simulator, "bicycle::" + name, "joint").joint];
  }

  /** [rad] to the right */
  Eigen::Vector2d leanAndSteer() const {
    const StepReport& report = simulator.report();
    const Matrix3 frame = report.bodies[simulator.robots()[0].bodies[0]].X_WB.linear();
    return {std::asin(frame(2, 1)), -report.joints[jointOf("of_fork")].position};
  }

  Simulator simulator;
};

/** Pushed aside, it steers itself upright again: at 5.8 m/s theory has it weave at 5.60 rad/s, dying out by 1.39 per second. */
TEST_F(Bicycle, SteersItselfUpright) {
  const double dt = simulator.config().time_step;
  stepFor(&simulator, 0.2);
  const Eigen::Vector2d before = leanAndSteer();
  simulator.step();
  const Eigen::Vector2d then = leanAndSteer();
  simulator.step();
  Eigen::Vector4d state;
  state << then, (leanAndSteer() - before) / (2 * dt);
  const Eigen::Matrix4d system = whipple(SPEED);
  double most = 0, miss = 0;
  for (state = later(system, state, dt); simulator.time() < 1.7; state = later(system, state, dt)) {
    most = std::max(most, leanAndSteer().cwiseAbs().maxCoeff());
    miss = std::max(miss, (leanAndSteer() - state.head<2>()).cwiseAbs().maxCoeff());
    simulator.step();
  }
  EXPECT_GT(most, 0.04);
  EXPECT_LT(miss, 0.01 * most);
}

}  // namespace
}  // namespace blem_sim::sim
