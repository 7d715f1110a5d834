// A robot that stands still and looks at something.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "blem_sim/sim/range_view.h"
#include "sim/simulation_scene.h"

namespace blem_sim::sim {

/** A mast at the origin without a collision, and a fin of it: a plate of 2 cm from 0.19 to 0.21 m ahead, half a metre to the left. */
inline const char* const MAST = R"(<robot name="mast">
  <link name="mast"><inertial><mass value="5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0.2 0.5 0"/><geometry><box size="0.02 0.6 0.6"/></geometry></collision></link>
</robot>)";

inline SensorConfig depthCamera() {
  SensorConfig config;
  config.name = "camera";
  config.type = SensorType::DEPTH_CAMERA;
  config.link = "mast";
  config.rays.width = 33;
  config.rays.height = 17;
  return config;
}

inline SensorConfig lidar() {
  SensorConfig config;
  config.name = "scan";
  config.type = SensorType::LIDAR;
  config.link = "mast";
  config.rays.nearest = 0.1;
  config.rays.farthest = 30;
  config.rays.beams = 181;
  config.rays.first_angle = -M_PI / 2;
  config.rays.last_angle = M_PI / 2;
  return config;
}

/** A robot that stands still with one sensor. */
inline SimulationConfig sceneWith(const SensorConfig& sensor) {
  SimulationConfig config;
  config.gravity = Vector3::Zero();
  config.robots = {robot("mast", MAST, true)};
  config.robots[0].sensors = {sensor};
  return config;
}

inline EnvironmentConfig halfSpace(const Eigen::Vector4d& plane) {
  EnvironmentConfig environment;
  environment.name = "plane";
  environment.plane = plane;
  return environment;
}

inline std::vector<float> depthsIn(const SimulationConfig& config) {
  Simulator simulator(config, model::UriResolver());
  simulator.step();
  return depthsOf(*reading<DepthCameraReading>(simulator.report(), 0).view);
}

inline std::vector<float> rangesIn(const SimulationConfig& config) {
  Simulator simulator(config, model::UriResolver());
  simulator.step();
  return rangesOf(*reading<LidarReading>(simulator.report(), 0).view);
}

}  // namespace blem_sim::sim
