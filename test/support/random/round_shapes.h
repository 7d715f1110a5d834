// Coins, cans, logs and wheels that are URDF cylinders, and capsules, as the numbers say.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "sim/simulation_scene.h"
#include "support/random/scene_numbers.h"

namespace blem_sim {

/** Size and inertia of a cylinder. */
struct RoundShape {
  std::string kind;           ///< its word in descriptions
  double radius = 0, length;  ///< [m]
  double hollow = 0;          ///< 0: solid; 1: all mass in the mantle

  /** [m] */
  double shortest() const { return std::min(2 * radius, length); }
};

/** @param size [m] of the longer one of diameter and length */
inline RoundShape randomRound(SceneNumbers* n, double size) {
  const int kind = n->count(0, 3);
  if (kind == 0) return {"coin", size / 2, size * n->spread(0.02, 0.2), 0};
  if (kind == 1) return {"can", size * n->uniform(0.15, 0.5), size, n->uniform(0, 0.5)};
  if (kind == 2) return {"log", size * n->spread(0.01, 0.15), size, 0};
  return {"wheel", size / 2, size * n->uniform(0.1, 0.6), n->uniform(0, 1)};
}

/** Inertial and collision elements of a link that is a cylinder about its z axis. */
inline std::string roundText(const RoundShape& shape, double mass) {
  const double along = mass * shape.radius * shape.radius * (1 + shape.hollow) / 2;
  const double across = along / 2 + mass * shape.length * shape.length / 12;
  return fmt::format(R"(<inertial><mass value="{}"/><inertia ixx="{}" iyy="{}" izz="{}" ixy="0" ixz="0" iyz="0"/></inertial>)"
                     R"(<collision><geometry><cylinder radius="{}" length="{}"/></geometry></collision>)",
                     mass, across, across, along, shape.radius, shape.length);
}

/** Layer's width, inside of a cylinder, and whether boxes beside it shrink. */
inline sim::ContactOverrides roundSurface(SceneNumbers* n, double shortest) {
  sim::ContactOverrides surface;
  surface.boundary_width = std::min(0.0025, shortest * n->uniform(0.02, 0.1));
  surface.shrink = n->chance(0.5);
  if (n->chance(0.2)) surface.friction = n->uniform(0, 1.5);
  return surface;
}

inline sim::ObjectConfig roundObject(SceneNumbers* n, const std::string& name, const RoundShape& shape) {
  sim::ObjectConfig object;
  object.name = name;
  object.urdf_xml = fmt::format(R"(<robot name="{0}"><link name="link">{1}</link></robot>)", shape.kind, roundText(shape, 1));
  object.mass = n->uniform(100, 8000) * M_PI * shape.radius * shape.radius * shape.length;
  object.contact = roundSurface(n, shape.shortest());
  return object;
}

/** A cylinder between two balls, which is one segment with a layer. @param size [m] from end to end */
inline sim::ObjectConfig capsuleObject(SceneNumbers* n, const std::string& name, double size) {
  const double radius = size * n->uniform(0.1, 0.3), half = size / 2 - radius;
  std::string balls;
  for (const double z : {-half, half})
    balls += fmt::format(R"(<collision><origin xyz="0 0 {}"/><geometry><sphere radius="{}"/></geometry></collision>)", z, radius);
  sim::ObjectConfig object;
  object.name = name;
  object.urdf_xml =
      R"(<robot name="capsule"><link name="link">)" + roundText({"capsule", radius, 2 * half, 0}, 1) + balls + "</link></robot>";
  object.mass = n->uniform(100, 8000) * 3 * radius * radius * size;
  return object;
}

/** Pose of a cylinder at p whose axis leans by an angle off the vertical, towards a heading [rad], turned about it. */
inline Pose standingAt(const Vector3& p, double lean, double heading, double turn) {
  Pose X = Pose::Identity();
  X.linear() =
      (Eigen::AngleAxisd(heading, Vector3::UnitZ()) * Eigen::AngleAxisd(lean, Vector3::UnitY()) * Eigen::AngleAxisd(turn, Vector3::UnitZ()))
          .toRotationMatrix();
  X.translation() = p;
  return X;
}

/** [m] From the middle of a cylinder that leans by an angle down to its lowest point. */
inline double reachBelow(const RoundShape& shape, double lean) {
  return 0.5 * shape.length * std::abs(std::cos(lean)) + shape.radius * std::abs(std::sin(lean));
}

}  // namespace blem_sim
