// Carts whose wheels are cylinders, hands that close on one, and tables of rollers, with and without motors.
#pragma once

#include <fmt/format.h>

#include <string>

#include "support/random/random_robot.h"
#include "support/random/round_shapes.h"

namespace blem_sim {

/** A link that is a cylinder about y, on a joint that turns without end; @param place xyz in its parent */
inline std::string axleText(const std::string& parent, const std::string& name, const Vector3& place, const std::string& link) {
  return fmt::format(R"(<link name="{0}">{1}</link><joint name="{0}_joint" type="continuous"><parent link="{2}"/><child link="{0}"/>)"
                     R"(<origin xyz="{3} {4} {5}" rpy="-1.5707963267948966 0 0"/><axis xyz="0 0 1"/></joint>)",
                     name, link, parent, place.x(), place.y(), place.z());
}

/** Gives an axle a motor that keeps a velocity [rad/s], with an effort limit or without. */
inline void turnAxle(SceneNumbers* n, const std::string& axle, double speed, RandomRobot* robot) {
  const std::string joint = axle + "_joint";
  robot->config.gains[joint] = {0, 0, n->spread(1e-3, 1e2)};
  robot->config.motor[joint] = sim::MotorLaw::IMPLICIT_PD;
  if (n->chance(0.5)) robot->config.effort_limits[joint] = n->spread(1e-2, 1e2);
  robot->command.joints.push_back(joint);
  robot->command.velocities.push_back(speed);
}

inline void setRoundRobot(const std::string& name, const std::string& text, const sim::ContactOverrides& surface, RandomRobot* robot) {
  robot->config.name = name;
  robot->config.motors = sim::MotorDefault::FREE;
  robot->config.urdf_xml = fmt::format(R"(<robot name="{}">)", name) + text + "</robot>";
  robot->config.contact = surface;
}

/** A chassis on two to six wheels that stands on z = 0 at a place, or above it. @param size [m] of its wheels */
inline RandomRobot randomCart(SceneNumbers* n, const std::string& name, const Vector3& place, double size) {
  RandomRobot robot;
  const RoundShape wheel{"wheel", size / 2, size * n->uniform(0.05, 0.6), n->uniform(0, 1)};
  const sim::ContactOverrides surface = roundSurface(n, wheel.shortest());
  const int axles = n->count(1, 3);
  const double density = n->uniform(100, 3000), mass = density * M_PI * wheel.radius * wheel.radius * wheel.length;
  const double spacing = 2.2 * size, width = size * n->uniform(0.8, 2), load = n->spread(0.3, 30) * mass;
  const Vector3 box(spacing * axles, width, 0.4 * size);
  robot.driven = n->chance(0.6);
  std::string text = fmt::format(R"(<link name="chassis">{}<collision><geometry><box size="{} {} {}"/></geometry></collision></link>)",
                                 massText(load, Vector3::Zero(), box), box.x(), box.y(), box.z());
  const double speed = n->uniform(-1, 1) * n->spread(1, 300);
  const double aside = 0.5 * (width + wheel.length) + 3 * surface.boundary_width->metres;
  for (int i = 0; i < axles; ++i)
    for (const int side : {-1, 1}) {
      const std::string wheel_name = fmt::format("wheel{}{}", i, side < 0 ? "right" : "left");
      text += axleText("chassis", wheel_name, {spacing * (i - 0.5 * (axles - 1)), side * aside, 0}, roundText(wheel, mass));
      if (robot.driven) turnAxle(n, wheel_name, n->chance(0.8) ? speed : -speed, &robot);
      if (n->chance(0.2)) robot.config.joint_friction[wheel_name + "_joint"] = {n->spread(1e-5, 0.1), n->spread(1e-5, 0.1)};
    }
  setRoundRobot(name, text, surface, &robot);
  robot.config.self_collision = n->chance(0.2);
  const double over = n->chance(0.5) ? 0 : n->uniform(0, 2) * size;
  robot.config.X_WR =
      standingAt(place + Vector3(0, 0, wheel.radius + over), n->chance(0.2) ? n->uniform(-1, 1) : 0, n->uniform(-M_PI, M_PI), 0);
  robot.description = fmt::format("cart on {} wheels of {:.2g} m, {:.2g} on {:.2g} kg{}", 2 * axles, size, load, mass,
                                  robot.driven ? fmt::format(", at {:.2g} rad/s", speed) : "");
  return robot;
}

/** A table of rollers along x on the world; belts where they all turn. @param size [m] of the rollers */
inline RandomRobot randomRollers(SceneNumbers* n, const std::string& name, const Vector3& place, double size) {
  RandomRobot robot;
  const int rollers = n->count(2, 6);
  const RoundShape roller{"roller", size / 2, size * n->uniform(1, 8), n->uniform(0, 1)};
  const sim::ContactOverrides surface = roundSurface(n, roller.shortest());
  const double mass = n->uniform(100, 8000) * M_PI * roller.radius * roller.radius * roller.length;
  const double spacing = size * n->uniform(1.1, 1.6) + 2 * surface.boundary_width->metres, speed = n->uniform(-1, 1) * n->spread(1, 100);
  robot.driven = n->chance(0.6);
  std::string text = R"(<link name="frame"/>)";
  for (int i = 0; i < rollers; ++i) {
    const std::string roller_name = fmt::format("roller{}", i);
    text += axleText("frame", roller_name, {spacing * (i - 0.5 * (rollers - 1)), 0, 0}, roundText(roller, mass));
    if (robot.driven) turnAxle(n, roller_name, n->chance(0.8) ? speed : -speed, &robot);
  }
  setRoundRobot(name, text, surface, &robot);
  robot.config.fixed_base = true;
  robot.config.X_WR = makePose(place + Vector3(0, 0, size));
  robot.description = fmt::format("{} rollers of {:.2g} m{}", rollers, size, robot.driven ? fmt::format(", at {:.2g} rad/s", speed) : "");
  return robot;
}

}  // namespace blem_sim
