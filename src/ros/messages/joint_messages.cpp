#include "messages/joint_messages.h"

#include "messages/conversions.h"

namespace blem_sim {

sensor_msgs::JointState statesOf(const RobotInfo& robot) {
  sensor_msgs::JointState message;
  message.name = robot.joint_names;
  message.position.resize(robot.joints.size());
  message.velocity.resize(robot.joints.size());
  message.effort.resize(robot.joints.size());
  return message;
}

void writeStates(const StepReport& report, const RobotInfo& robot, sensor_msgs::JointState* message) {
  message->header.stamp = toStamp(report.time);
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const JointState& state = report.joints[robot.joints[i]];
    message->position[i] = state.position;
    message->velocity[i] = state.velocity;
    message->effort[i] = state.effort;
  }
}

JointCommandMessage commandOf(const sensor_msgs::JointState& message) {
  JointCommandMessage command;
  command.joints = message.name;
  command.positions = message.position;
  command.velocities = message.velocity;
  command.efforts = message.effort;
  return command;
}

}  // namespace blem_sim
