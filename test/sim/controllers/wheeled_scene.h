// A robot on wheels upon a plane.
#pragma once

#include "sim/simulation_scene.h"

namespace blem_sim::sim {

/** Its wheels hold by friction 1. @param height [m] of its root */
inline SimulationConfig wheeledScene(const RobotConfig& robot, double height) {
  SimulationConfig config;
  config.contact.surface.friction = 1;
  EnvironmentConfig plane;
  plane.name = "plane";
  plane.plane = Eigen::Vector4d(0, 0, 1, 0);
  config.environments = {plane};
  config.robots = {robot};
  config.robots[0].X_WR = makePose({0, 0, height});
  return config;
}

}  // namespace blem_sim::sim
