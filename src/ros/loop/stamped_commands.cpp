#include "loop/stamped_commands.h"

#include <fmt/format.h>
#include <ros/console.h>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::node {

namespace {
constexpr double ROUNDING = 1e-9;  // [s] of stamps, which count nanoseconds
}

bool StampedCommands::isDue(double stamp) const { return stamp <= simulator_.time() + ROUNDING; }

void StampedCommands::check(int robot, const sim::JointCommandMessage& command, double stamp) const {
  simulator_.checkJointCommand(robot, command);
  const double ahead = stamp - simulator_.time();
  if (ahead > FARTHEST_AHEAD)
    throw InputError(
        fmt::format("header.stamp: lies {:.6g} s ahead of simulated time; stamp by /clock, or leave it 0, which means now", ahead));
  if (!isDue(stamp) && waiting_.size() >= MOST)
    throw InputError(fmt::format("header.stamp: {} commands wait for their steps, which is the most; send them later", MOST));
}

void StampedCommands::give(int robot, const sim::JointCommandMessage& command, double stamp) {
  check(robot, command, stamp);
  if (isDue(stamp))
    simulator_.commandJoints(robot, command);
  else
    waiting_.insert({stamp, {simulator_.robots()[robot].name, command}});
}

void StampedCommands::giveDue() {
  while (!waiting_.empty() && isDue(waiting_.begin()->first)) {
    const Waiting due = waiting_.extract(waiting_.begin()).mapped();
    const int robot = simulator_.robotIndex(due.robot);
    try {
      if (robot >= 0) simulator_.commandJoints(robot, due.command);
    } catch (const InputError& error) {  // another robot has the name by now
      ROS_ERROR("joint_command: command refused in its step: %s", error.what());
    }
  }
}

}  // namespace blem_sim::node
