// Joints' states and targets as sensor_msgs/JointState.
#pragma once

#include <sensor_msgs/JointState.h>

#include "blem_sim/sim/simulator_types.h"
#include "blem_sim/sim/step_report.h"

namespace blem_sim::node {

/** A message with the names of a robot's movable joints and room for their states. */
sensor_msgs::JointState statesOf(const sim::RobotInfo& robot);
/** Writes time and states [rad or m, and per second; N m or N of the motors]. @param message one of statesOf */
void writeStates(const sim::StepReport& report, const sim::RobotInfo& robot, sensor_msgs::JointState* message);

sim::JointCommandMessage commandOf(const sensor_msgs::JointState& message);

}  // namespace blem_sim::node
