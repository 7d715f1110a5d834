// Values of a <gazebo> itself: surfaces and self collision of links, settings of joints and of the robot.
#pragma once

#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"
#include "gazebo/gazebo_notes.h"

namespace blem_sim::sim {

/** Reads what stands in a <gazebo> beside its sensors and plugins into described_links and the self collision of a robot. */
void readGazeboValues(const model::GazeboBlock& block, const model::RobotModel& model, GazeboNotes* notes, RobotConfig* config);

}  // namespace blem_sim::sim
