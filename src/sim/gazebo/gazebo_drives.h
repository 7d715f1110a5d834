// Drives of a robot's <gazebo> blocks.
#pragma once

#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"
#include "gazebo/gazebo_notes.h"

namespace blem_sim::sim {

/** Adds a drive to a robot's configuration, unless a controller there has its name. @return whether the plugin is one for drives */
bool readGazeboDrive(const model::GazeboBlock& plugin, const model::RobotModel& model, GazeboNotes* notes, RobotConfig* config);

}  // namespace blem_sim::sim
