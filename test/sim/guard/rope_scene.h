// A rope of light links with a weight at each end, laid over a drum.
#pragma once

#include <cmath>
#include <string>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {

/** Links of the rope are balls at its hinges, which turn about y; the drum is a mesh. */
struct RopeOverDrum {
  int around = 16, hanging = 5;  // hinges that bend about the drum, and links that hang on each side
  double length = 0.01;          // [m] of a link
  double radius = 0.002;         // [m] of its ball
  double link_mass = 2e-4;       // [kg]
  double left = 1, right = 1;    // [kg] of the weights
  double friction = 0.3;
  double armature = 0;  // [kg m^2] of each hinge

  int links() const { return around + 2 * hanging; }
  double turn() const { return M_PI / around; }
  /** Largest ratio of the weights at which friction holds the rope: a hinge after the other, Euler and Eytelwein's e^(mu pi). */
  double holds() const {
    const double share = friction * std::tan(0.5 * turn());
    return std::pow((1 + share) / (1 - share), around);
  }
  double weight() const { return G * (left + right + (links() - 1) * link_mass); }
};

inline std::string ropeLink(const std::string& name, double mass, double radius) {
  const double inertia = std::max(1e-9, mass * 1e-4);
  return fmt::format(
      "<link name='{0}'><inertial><mass value='{1}'/><inertia ixx='{2}' iyy='{2}' izz='{2}' ixy='0' ixz='0' iyz='0'/></inertial>{3}</link>",
      name, mass, inertia, radius > 0 ? fmt::format("<collision><geometry><sphere radius='{}'/></geometry></collision>", radius) : "");
}

inline std::string ropeUrdf(const RopeOverDrum& rope) {
  std::string xml = "<robot name='rope'>" + ropeLink("link0", rope.left, 0);
  for (int i = 1; i <= rope.links(); ++i) {
    const bool last = i == rope.links(), bends = i > rope.hanging && i <= rope.hanging + rope.around;
    xml += ropeLink("link" + std::to_string(i), last ? rope.right : rope.link_mass, last ? 0 : rope.radius);
    xml += fmt::format(
        "<joint name='hinge{0}' type='continuous'><parent link='link{1}'/><child link='link{0}'/><origin xyz='0 0 {2}' rpy='0 {3} 0'/>"
        "<axis xyz='0 1 0'/></joint>",
        i, i - 1, i == 1 ? 0 : rope.length, bends ? rope.turn() : 0);
  }
  return xml + "</robot>";
}

/** The left weight hangs below the drum's left side, the right one below its right side; the balls begin 10 um above the drum. */
inline SimulationConfig ropeOverDrum(const RopeOverDrum& rope) {
  const double inner = 0.5 * rope.length / std::tan(0.5 * rope.turn()), outer = 0.5 * rope.length / std::sin(0.5 * rope.turn());
  SimulationConfig config;
  config.contact.surface.friction = rope.friction;
  EnvironmentConfig drum;
  drum.name = "drum";
  drum.uri = meshFile("drum", geometry::cylinderMesh(outer - rope.radius - 1e-5, 0.05, 256));
  drum.X_WE = makePose(Vector3::Zero(), Vector3(0.5 * M_PI, 0, 0));
  config.environments = {drum};
  RobotConfig robot;
  robot.name = "rope";
  robot.urdf_xml = ropeUrdf(rope);
  robot.fixed_base = false;
  robot.motors = MotorDefault::FREE;
  robot.X_WR = makePose(Vector3(-inner, 0, rope.length * (0.5 - rope.hanging)));
  if (rope.armature > 0) robot.armature["default"] = rope.armature;
  config.robots = {robot};
  return config;
}

}  // namespace blem_sim::sim
