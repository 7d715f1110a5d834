// Scenes of URDF cylinders, whose layers lie inside of them.
#pragma once

#include <fmt/format.h>

#include <string>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {

/** A cylinder about its z axis that is solid. */
struct SolidCylinder {
  double radius, length, mass;  // [m], [kg]

  /** Less a layer [m] inside: its rims bear it. */
  SolidCylinder core(double layer) const { return {radius - layer, length - 2 * layer, mass}; }
  /** [kg m^2] */
  double along() const { return 0.5 * mass * radius * radius; }
  double across() const { return mass * (3 * radius * radius + length * length) / 12; }
};

/** Inertial and collision elements. @param com [m] along the axis */
inline std::string cylinderText(const SolidCylinder& c, double com = 0) {
  return fmt::format(
      R"(<inertial><origin xyz="0 0 {}"/><mass value="{}"/><inertia ixx="{}" iyy="{}" izz="{}" ixy="0" ixz="0" iyz="0"/></inertial>)"
      R"(<collision><geometry><cylinder radius="{}" length="{}"/></geometry></collision>)",
      com, c.mass, c.across(), c.across(), c.along(), c.radius, c.length);
}

inline std::string boxText(const Vector3& size, double mass) {
  return fmt::format(R"(<inertial><mass value="{0}"/><inertia ixx="{0}" iyy="{0}" izz="{0}" ixy="0" ixz="0" iyz="0"/></inertial>)"
                     R"(<collision><geometry><box size="{1} {2} {3}"/></geometry></collision>)",
                     mass, size.x(), size.y(), size.z());
}

/** A link on a joint of the link "frame". @param pose "xyz" and "rpy" @param axis in the link's frame */
inline std::string jointedText(const std::string& name, const std::string& type, const std::string& pose, const std::string& axis,
                               const std::string& link) {
  const std::string limit = type == "prismatic" ? R"(<limit lower="-100" upper="100" effort="1e6" velocity="1e6"/>)" : "";
  return fmt::format(R"(<link name="{0}">{4}</link><joint name="{0}_joint" type="{1}"><parent link="frame"/><child link="{0}"/>)"
                     R"(<origin {2}/><axis xyz="{3}"/>{5}</joint>)",
                     name, type, pose, axis, link, limit);
}

const char* const ALONG_Y = R"(rpy="-1.5707963267948966 0 0")";

inline RobotConfig machine(const std::string& name, const std::string& links) {
  return robot(name, fmt::format(R"(<robot name="{}"><link name="frame"/>)", name) + links + "</robot>", true);
}

/** @param layer [m] inside of cylinders, around boxes */
inline SimulationConfig roundConfig(double friction, double layer) {
  SimulationConfig config;
  config.contact.surface.friction = friction;
  config.contact.boundary_width = layer;
  config.contact.shrink = false;
  return config;
}

inline EnvironmentConfig level(double height = 0) {
  EnvironmentConfig environment;
  environment.name = "level";
  environment.plane = Eigen::Vector4d(0, 0, 1, height);
  return environment;
}

/** A fixed box whose top is at a height. */
inline EnvironmentConfig block(const std::string& name, const Vector3& size, const Vector3& top) {
  EnvironmentConfig environment;
  environment.name = name;
  environment.uri = meshFile("block_" + name, geometry::boxMesh(size));
  environment.X_WE = makePose(top - Vector3(0, 0, 0.5 * size.z()));
  return environment;
}

/** At a place, its axis along y. @param com [m] along its axis */
inline ObjectConfig cylinderAlongY(const std::string& name, const SolidCylinder& c, const Vector3& place, double com = 0) {
  ObjectConfig object;
  object.name = name;
  object.urdf_xml = fmt::format("<robot name='{0}'><link name='{0}'>", name) + cylinderText(c, com) + "</link></robot>";
  object.X_WO = makePose(place, {-M_PI / 2, 0, 0});
  return object;
}

/** Rolls along x. @param speed [m/s] */
inline void roll(double speed, double radius, ObjectConfig* object) {
  object->linear_velocity = {speed, 0, 0};
  object->angular_velocity = {0, speed / radius, 0};
}

}  // namespace blem_sim::sim
