// A car and a tricycle, on wheels that are balls and roll on one point.
#pragma once

#include <string>

#include "sim/controllers/wheeled_scene.h"

namespace blem_sim::sim {

constexpr double CAR_WHEEL = 0.1, CAR_TRACK = 0.4, CAR_WHEELBASE = 0.5;  // [m]

/** Builds the URDF of a robot on steered wheels, part by part. */
class SteeredUrdf {
 public:
  SteeredUrdf() {
    urdf_ = R"(<robot name="car"><link name="base_link"><inertial><mass value="8"/>
      <inertia ixx="0.1" iyy="0.2" izz="0.3" ixy="0" ixz="0" iyz="0"/></inertial></link>)";
  }
  /** A wheel at a place of the base, its joint named NAME_axle. */
  SteeredUrdf& wheel(const std::string& name, double x, double y, const std::string& parent = "base_link") {
    urdf_ += fmt::format(R"(<link name="{0}"><inertial><mass value="0.5"/><inertia ixx="0.002" iyy="0.002" izz="0.002" ixy="0" ixz="0"
      iyz="0"/></inertial><collision><geometry><sphere radius="{1}"/></geometry></collision></link><joint name="{0}_axle" type="continuous">
      <parent link="{2}"/><child link="{0}"/><origin xyz="{3} {4} 0"/><axis xyz="0 1 0"/></joint>)",
                         name, CAR_WHEEL, parent, x, y);
    return *this;
  }
  /** A wheel that is steered by a joint named NAME_steer, as far as `limit` [rad]. */
  SteeredUrdf& steeredWheel(const std::string& name, double x, double y, double limit) {
    urdf_ += fmt::format(R"(<link name="{0}_fork"><inertial><mass value="0.3"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0"
      iyz="0"/></inertial></link><joint name="{0}_steer" type="revolute"><parent link="base_link"/><child link="{0}_fork"/>
      <origin xyz="{1} {2} 0"/><axis xyz="0 0 1"/><limit lower="-{3}" upper="{3}" effort="50" velocity="20"/></joint>)",
                         name, x, y, limit);
    return wheel(name, 0, 0, name + "_fork");
  }
  std::string with(const std::string& blocks = "") const { return urdf_ + blocks + "</robot>"; }

 private:
  std::string urdf_;
};

/** Its base is in its middle, on the height of the axles. */
inline std::string carUrdf() {
  const double x = CAR_WHEELBASE / 2, y = CAR_TRACK / 2;
  return SteeredUrdf()
      .wheel("rear_left", -x, y)
      .wheel("rear_right", -x, -y)
      .steeredWheel("left", x, y, 1.2)
      .steeredWheel("right", x, -y, 1.2)
      .with();
}

/** Its base is in the middle of its rear axle. */
inline std::string tricycleUrdf(const std::string& blocks = "") {
  const double y = CAR_TRACK / 2;
  return SteeredUrdf().wheel("left", 0, y).wheel("right", 0, -y).steeredWheel("front", CAR_WHEELBASE, 0, 1.6).with(blocks);
}

/** The robot named car stands on a plane, where its wheels hold by friction 1. @param drive of its configuration */
inline SimulationConfig steeredScene(const std::string& urdf, const ControllerConfig& drive) {
  SimulationConfig config = wheeledScene(robot("car", urdf, false), CAR_WHEEL);
  config.robots[0].motors = MotorDefault::COMPUTED;
  config.robots[0].motor.clear();
  config.robots[0].controllers = {drive};
  return config;
}

}  // namespace blem_sim::sim
