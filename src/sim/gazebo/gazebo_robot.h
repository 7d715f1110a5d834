// A robot's configuration with what the <gazebo> blocks of its URDF add.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"

namespace blem_sim::sim {

struct GazeboRobot {
  RobotConfig config;
  std::vector<std::string> notes;  ///< what was made of the blocks, what was not, and why
};

/**
 * Adds surfaces, self collision, sensors and drives. The configuration beats the URDF: a sensor whose name or topic it has, a drive whose
 * name a controller has, and the surfaces that it sets, stay as they are. What is not understood or cannot be used is told in the notes;
 * nothing throws.
 */
GazeboRobot withGazeboBlocks(const RobotConfig& config, const model::RobotModel& model);

}  // namespace blem_sim::sim
