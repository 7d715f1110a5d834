// Commands between steps: all of a command is checked before any of it takes effect.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "blem_sim/geometry/input_error.h"
#include "numbers/nearest_name.h"
#include "numbers/nearest_turn.h"
#include "simulator_impl.h"

namespace blem_sim::sim {
namespace {

using Knot = JointSpline::Knot;

double valueAt(const std::vector<double>& values, std::size_t i) { return values.empty() ? 0 : values[i]; }

std::vector<Knot> knotsOf(const JointTrajectory& trajectory, std::size_t joint, double start) {
  std::vector<Knot> knots;
  for (const TrajectoryPoint& point : trajectory.points) {
    const int order = point.velocities.empty() ? 1 : point.accelerations.empty() ? 3 : 5;
    knots.push_back({start + point.time_from_start, point.positions[joint], valueAt(point.velocities, joint),
                     valueAt(point.accelerations, joint), valueAt(point.effort, joint), order});
  }
  return knots;
}

std::size_t placeAmong(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) - names.begin();
}

void checkCommanded(const std::vector<double>& values, const JointCommandMessage& command, const std::string& where, const char* field) {
  if (values.empty()) return;
  if (values.size() != command.joints.size())
    throw InputError(
        fmt::format("{}: {}: {} values for {} joints; give one each, or none", where, field, values.size(), command.joints.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!isCommand(values[i]))
      throw InputError(fmt::format("{}: {}: joint '{}' has {}; numbers must be finite, and not beyond {:g}", where, field,
                                   command.joints[i], values[i], LARGEST_COMMAND));
}

}  // namespace

void Simulator::Impl::commandTrajectory(int robot, const JointTrajectory& trajectory) {
  const RobotInfo& info = world_.robots.at(robot);
  try {
    checkTrajectory(trajectory, info.joint_names);
  } catch (const InputError& error) {
    throw InputError(fmt::format("robot '{}': {}", info.name, error.what()));
  }
  const double now = time(), start = trajectory.start_time > 0 ? trajectory.start_time : now;
  const std::vector<std::string>& joints = trajectory.joints.empty() ? info.joint_names : trajectory.joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const int joint = info.joints[placeAmong(info.joint_names, joints[i])];
    world_.motors[joint].follow(now, start, knotsOf(trajectory, i, start), world_.world.jointState(joint).position);
  }
}

void Simulator::Impl::checkJointCommand(int robot, const JointCommandMessage& command) const {
  const RobotInfo& info = world_.robots.at(robot);
  const std::string where = "robot '" + info.name + "': joint command";
  std::set<std::string> seen;
  for (const std::string& joint : command.joints) {
    requireName(joint, info.joint_names, where, "movable joint");
    if (!seen.insert(joint).second) throw InputError(fmt::format("{}: joint '{}' is there twice; name it once", where, joint));
  }
  checkCommanded(command.positions, command, where, "position");
  checkCommanded(command.velocities, command, where, "velocity");
  checkCommanded(command.efforts, command, where, "effort");
}

void Simulator::Impl::commandJoints(int robot, const JointCommandMessage& command) {
  const RobotInfo& info = world_.robots.at(robot);
  checkJointCommand(robot, command);
  for (std::size_t i = 0; i < command.joints.size(); ++i) {
    const int joint = info.joints[placeAmong(info.joint_names, command.joints[i])];
    JointMotor& motor = world_.motors[joint];
    if (!command.positions.empty())
      motor.hold(nearestTurn(joint, command.positions[i]), valueAt(command.velocities, i));
    else if (!command.velocities.empty())
      motor.keepVelocity(command.velocities[i], time());
    else if (!command.efforts.empty())
      motor.keepEffort(command.efforts[i], time());
    if (!command.efforts.empty()) motor.addEffort(command.efforts[i]);
  }
}

void Simulator::Impl::driveJoints(int robot, const JointVelocityCommand& command) {
  const RobotInfo& info = world_.robots.at(robot);
  checkJointCommand(robot, {command.joints, {}, command.velocities, {}});
  for (const double number : {command.acceleration, command.max_effort})
    if (!(number >= 0) || !isCommand(number))
      throw InputError(
          fmt::format("robot '{}': velocity command: acceleration and effort must be from 0 to {:g}", info.name, LARGEST_COMMAND));
  if (command.velocities.size() != command.joints.size())
    throw InputError(fmt::format("robot '{}': velocity command: give each joint a velocity", info.name));
  for (std::size_t i = 0; i < command.joints.size(); ++i) {
    const int joint = info.joints[placeAmong(info.joint_names, command.joints[i])];
    world_.motors[joint].driveVelocity({command.velocities[i], command.acceleration, command.max_effort}, time());
  }
}

void Simulator::Impl::checkBase(int robot) const {
  const RobotInfo& info = world_.robots.at(robot);
  const std::string& stepper = config_.solver.stepper;
  if (info.fixed_base)
    throw InputError(fmt::format("robot '{}': its base is fixed, so nothing pushes it; leave fixed_base out", info.name));
  if (stepper != "articulated")
    throw InputError(fmt::format("robot '{}': {} pushes no base; set solver.stepper to articulated", info.name, stepper));
}

void Simulator::Impl::driveBase(int robot, int link, const BaseVelocityCommand& command) {
  checkBase(robot);
  const RobotInfo& info = world_.robots.at(robot);
  const auto refuse = [&](const std::string& why) { throw InputError(fmt::format("robot '{}': base velocity: {}", info.name, why)); };
  for (const double number : {command.x, command.y, command.turn, command.max_force, command.max_torque})
    if (!isCommand(number)) refuse(fmt::format("has {}; numbers must be finite, and not beyond {:g}", number, LARGEST_COMMAND));
  if (command.max_force < 0 || command.max_torque < 0) refuse("bounds are below 0; give 0 or more");
  const std::vector<model::LinkPlacement>& placed = info.lumped->link_placement;
  if (link < 0 || link >= static_cast<int>(placed.size()))
    refuse(fmt::format("it has no link {}; its links are 0 to {}", link, placed.size() - 1));
  const Pose X_BL = placed[link].body == 0 ? placed[link].X_BL : Pose::Identity();
  const CarriedFrame frame{X_BL.translation(), X_BL.linear().col(0)};
  base_drives_.set(info.bodies[0], frame, withBounds(command, world_.world, world_.models[info.model].bodies));
}

void Simulator::Impl::releaseBase(int robot) { base_drives_.clearBody(world_.robots.at(robot).bodies[0]); }

double Simulator::Impl::nearestTurn(int joint, double position) const {
  if (!world_.motors[joint].settings().continuous) return position;
  return position + turnsTo(world_.world.jointState(joint).position, position);
}

JointSample Simulator::Impl::desiredState(int joint, double time) const {
  const dynamics::JointSpec& spec = world_.world.jointSpec(joint);
  if (spec.mimic_joint < 0) return world_.motors[joint].desired(time);
  const JointSample master = desiredState(spec.mimic_joint, time);
  return {spec.mimic_multiplier * master.position + spec.mimic_offset, spec.mimic_multiplier * master.velocity,
          spec.mimic_multiplier * master.acceleration, 0};
}

}  // namespace blem_sim::sim
