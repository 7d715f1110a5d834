// Chains, trees and hands as inline URDF, with motors, limits, friction and mimic joints as the numbers say.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "blem_sim/sim/simulator.h"
#include "support/random/scene_numbers.h"

namespace blem_sim {

/** A robot of a random scene and its joints' command at the start. */
struct RandomRobot {
  sim::RobotConfig config;
  sim::JointCommandMessage command;
  bool driven = false;  ///< a motor, which may do work
  std::string description;
};

inline std::string massText(double mass, const Vector3& com, const Vector3& size) {
  const Vector3 squares = size.cwiseAbs2();
  return fmt::format(
      R"(<inertial><origin xyz="{} {} {}"/><mass value="{}"/><inertia ixx="{}" iyy="{}" izz="{}" ixy="0" ixz="0" iyz="0"/></inertial>)",
      com.x(), com.y(), com.z(), mass, mass / 12 * (squares.y() + squares.z()), mass / 12 * (squares.x() + squares.z()),
      mass / 12 * (squares.x() + squares.y()));
}

/** A bar along x from its frame, box, rod or ball, as the number says; 0: no shape. */
inline std::string linkText(const std::string& name, double mass, double length, double width, int shape) {
  std::string collision;
  const std::string origin = fmt::format(R"(<collision><origin xyz="{} 0 0" rpy="0 1.5707963267948966 0"/><geometry>)", length / 2);
  if (shape == 1) collision = origin + fmt::format(R"(<box size="{} {} {}"/>)", width, width, 0.8 * length) + "</geometry></collision>";
  if (shape == 2)
    collision = origin + fmt::format(R"(<cylinder radius="{}" length="{}"/>)", width / 2, 0.8 * length) + "</geometry></collision>";
  if (shape == 3) collision = origin + fmt::format(R"(<sphere radius="{}"/>)", width / 2) + "</geometry></collision>";
  return fmt::format(R"(<link name="{}">{}{}</link>)", name, massText(mass, {length / 2, 0, 0}, {length, width, width}), collision);
}

struct RandomJoint {
  std::string name, type, parent, child, extras;
  double at = 0;  // [m] along the parent
  Vector3 axis;
  double range = 1e3;  // [rad or m] to both sides
  double effort = 1e6;
};

inline std::string jointText(const RandomJoint& j) {
  const std::string limit = j.type == "continuous"
                                ? ""
                                : fmt::format(R"(<limit lower="{}" upper="{}" effort="{}" velocity="1e6"/>)", -j.range, j.range, j.effort);
  return fmt::format(
      R"(<joint name="{}" type="{}"><parent link="{}"/><child link="{}"/><origin xyz="{} 0 0"/><axis xyz="{} {} {}"/>{}{}</joint>)", j.name,
      j.type, j.parent, j.child, j.at, j.axis.x(), j.axis.y(), j.axis.z(), limit, j.extras);
}

/** Motor, friction and rotor of a joint; explicit PID only with gains that a step can bear. */
inline void driveJoint(SceneNumbers* numbers, const std::string& joint, RandomRobot* robot) {
  if (numbers->chance(0.3)) robot->config.joint_friction[joint] = {numbers->spread(1e-4, 1), numbers->spread(1e-4, 1)};
  if (numbers->chance(0.2)) robot->config.armature[joint] = numbers->spread(1e-5, 1e-1);
  if (!robot->driven) return;
  const double stiffness = numbers->spread(1e-2, 1e5);
  sim::JointGains gains;
  gains.p = stiffness;
  gains.d = numbers->chance(0.2) ? 0 : stiffness * numbers->spread(1e-3, 0.3);
  robot->config.gains[joint] = gains;
  robot->config.motor[joint] = sim::MotorLaw::IMPLICIT_PD;
  if (numbers->chance(0.5)) robot->config.effort_limits[joint] = numbers->spread(1e-2, 1e3);
  robot->command.joints.push_back(joint);
  robot->command.positions.push_back(numbers->uniform(-1, 1));
}

/** A chain or a tree of 2 to 8 links that taper or grow. */
inline RandomRobot randomTree(SceneNumbers* numbers, const std::string& name, const Vector3& position, double size) {
  RandomRobot robot;
  const int links = numbers->count(2, 8);
  const bool chain = numbers->chance(0.6), limited = numbers->chance(0.4), mimics = numbers->chance(0.15);
  const double taper = numbers->spread(0.2, 1.3), rod = numbers->uniform(0.1, 0.4);
  const int shape = numbers->chance(0.7) ? numbers->count(1, 3) : 0;
  robot.driven = numbers->chance(0.6);
  double mass = numbers->spread(0.1, 10), length = size;
  std::vector<double> lengths{length};
  std::string text = fmt::format(R"(<robot name="{}">)", name) + linkText("link0", mass, length, rod * length, shape);
  for (int i = 1; i < links; ++i) {
    mass = std::clamp(mass * taper, 1e-3, 1e3);
    length = std::max(length * std::cbrt(taper), 0.02 * size);
    lengths.push_back(length);
    const int parent = chain ? i - 1 : numbers->count(0, i - 1);
    RandomJoint joint{fmt::format("joint{}", i),
                      numbers->chance(0.2) ? "prismatic"
                      : limited            ? "revolute"
                                           : "continuous",
                      fmt::format("link{}", parent),
                      fmt::format("link{}", i),
                      "",
                      lengths[parent],
                      numbers->direction()};
    joint.range = joint.type == "prismatic" ? 0.3 * size : numbers->uniform(0.1, 3);
    const bool follows = mimics && i > 1 && joint.type != "prismatic";
    if (follows) joint.extras = fmt::format(R"(<mimic joint="joint{}" multiplier="{}"/>)", 1, numbers->uniform(-2, 2));
    text += linkText(joint.child, mass, length, rod * length, shape) + jointText(joint);
    if (!follows) driveJoint(numbers, joint.name, &robot);
    if (!follows && numbers->chance(0.5)) robot.config.initial_positions[joint.name] = numbers->uniform(-0.5, 0.5);
  }
  robot.config.name = name;
  robot.config.motors = sim::MotorDefault::FREE;
  robot.config.urdf_xml = text + "</robot>";
  robot.config.fixed_base = numbers->chance(0.5);
  robot.config.self_collision = numbers->chance(0.2);
  robot.config.X_WR = makePose(position, numbers->direction() * numbers->uniform(0, M_PI));
  robot.description = fmt::format("{} of {} links, {:.2g} m, taper {:.2g}{}{}{}{}", chain ? "chain" : "tree", links, size, taper,
                                  robot.config.fixed_base ? ", fixed" : "", robot.driven ? ", motors" : "", limited ? ", limits" : "",
                                  mimics ? ", mimic" : "");
  return robot;
}

/** A hand of two fingers along x that hangs from the world and closes on a body of `width` between them. */
inline RandomRobot randomHand(SceneNumbers* numbers, const std::string& name, const Vector3& position, double width) {
  RandomRobot robot;
  robot.driven = true;
  std::string text = fmt::format(R"(<robot name="{}"><link name="palm"/>)", name);
  const bool mimic = numbers->chance(0.3);
  const double force = numbers->spread(0.1, 100), stiffness = numbers->spread(1e2, 1e5);
  for (const int side : {-1, 1}) {
    const std::string finger = side < 0 ? "left" : "right";
    text += fmt::format(R"(<link name="{}">{}<collision><geometry><box size="{} {} {}"/></geometry></collision></link>)", finger,
                        massText(numbers->spread(0.02, 2), Vector3::Zero(), {0.2 * width, width, width}), 0.2 * width, width, width);
    const std::string follows = mimic && side > 0 ? R"(<mimic joint="left_joint" multiplier="1"/>)" : "";
    text += fmt::format(
        R"(<joint name="{0}_joint" type="prismatic"><parent link="palm"/><child link="{0}"/><origin xyz="{1} 0 0"/><axis xyz="{2} 0 0"/>)"
        R"(<limit lower="{3}" upper="{4}" effort="{5}" velocity="1e6"/>{6}</joint>)",
        finger, side * 0.75 * width, -side, -width, width, force, follows);
    if (!follows.empty()) continue;
    const std::string joint = finger + "_joint";
    robot.config.gains[joint] = {stiffness, 0, 0.05 * stiffness};
    robot.config.motor[joint] = sim::MotorLaw::IMPLICIT_PD;
    robot.command.joints.push_back(joint);
    robot.command.positions.push_back(0.5 * width);
  }
  robot.config.name = name;
  robot.config.motors = sim::MotorDefault::FREE;
  robot.config.urdf_xml = text + "</robot>";
  robot.config.fixed_base = true;
  robot.config.X_WR = makePose(position);
  robot.description = fmt::format("hand {:.2g} m wide, {:.2g} N{}", width, force, mimic ? ", mimic" : "");
  return robot;
}

}  // namespace blem_sim
