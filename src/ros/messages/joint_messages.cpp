#include "messages/joint_messages.h"

#include "messages/conversions.h"

namespace blem_sim::node {

sensor_msgs::JointState statesOf(const sim::RobotInfo& robot) {
  sensor_msgs::JointState message;
  message.name = robot.joint_names;
  message.position.resize(robot.joints.size());
  message.velocity.resize(robot.joints.size());
  message.effort.resize(robot.joints.size());
  return message;
}

void writeStates(const sim::StepReport& report, const sim::RobotInfo& robot, sensor_msgs::JointState* message) {
  message->header.stamp = toStamp(report.time);
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const dynamics::JointState& state = report.joints[robot.joints[i]];
    message->position[i] = state.position;
    message->velocity[i] = state.velocity;
    message->effort[i] = state.effort;
  }
}

sim::JointCommandMessage commandOf(const sensor_msgs::JointState& message) {
  sim::JointCommandMessage command;
  command.joints = message.name;
  command.positions = message.position;
  command.velocities = message.velocity;
  command.efforts = message.effort;
  return command;
}

}  // namespace blem_sim::node
