// Commands, loads and questions by names.
#include <fmt/format.h>

#include <limits>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/named_parts.h"
#include "numbers_of.h"
#include "simulation.h"
#include "simulation_clearance.h"
#include "thread_turn.h"

namespace py = pybind11;

namespace blem_sim::python {

namespace {

int robotOf(const sim::Simulator& simulator, const std::string& name) {
  const int robot = simulator.robotIndex(name);
  if (robot >= 0) return robot;
  std::vector<std::string> known;
  for (const sim::RobotInfo& each : simulator.robots()) known.push_back(each.name);
  throw InputError(
      fmt::format("robot: there is no robot '{}'; there is {}", name, known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
}

std::vector<std::string> jointsOf(const sim::RobotInfo& robot, const py::object& joints) {
  return joints.is_none() ? robot.joint_names : namesOf(joints, "joints");
}

/** @throws InputError unless there are none, or one for each joint */
std::vector<double> oneForEach(const py::object& value, const std::string& name, std::size_t joints) {
  std::vector<double> numbers = numbersOf(value, name);
  if (!value.is_none() && numbers.size() != joints)
    throw InputError(fmt::format("{}: there are {} numbers for {} joints; give one for each", name, numbers.size(), joints));
  return numbers;
}

/** Time from now on; a duration of 0 [s] is that of the next step. */
sim::LoadTime timeOf(double duration) { return {0, duration == 0 ? std::numeric_limits<double>::min() : duration}; }

}  // namespace

std::vector<std::string> Simulation::robots() const {
  std::vector<std::string> names;
  for (const sim::RobotInfo& robot : simulator_->robots()) names.push_back(robot.name);
  return names;
}

std::vector<std::string> Simulation::robotJoints(const std::string& robot) const {
  return simulator_->robots()[static_cast<std::size_t>(robotOf(*simulator_, robot))].joint_names;
}

void Simulation::command(const std::string& robot, const CommandArguments& arguments) {
  const int index = robotOf(*simulator_, robot);
  sim::JointCommandMessage command;
  command.joints = jointsOf(simulator_->robots()[static_cast<std::size_t>(index)], arguments.joints);
  command.positions = oneForEach(arguments.positions, "positions", command.joints.size());
  command.velocities = oneForEach(arguments.velocities, "velocities", command.joints.size());
  command.efforts = oneForEach(arguments.efforts, "efforts", command.joints.size());
  change([&] { simulator_->commandJoints(index, command); });
}

void Simulation::commandTrajectory(const std::string& robot, const py::object& times, const CommandArguments& points, double start) {
  const int index = robotOf(*simulator_, robot);
  sim::JointTrajectory trajectory;
  trajectory.joints = jointsOf(simulator_->robots()[static_cast<std::size_t>(index)], points.joints);
  trajectory.start_time = start;
  const std::vector<double> moments = numbersOf(times, "times");
  const std::vector<std::vector<double>> positions = rowsOf(points.positions, "positions"),
                                         velocities = rowsOf(points.velocities, "velocities");
  if (positions.size() != moments.size() || (!points.velocities.is_none() && velocities.size() != moments.size()))
    throw InputError(fmt::format("positions: there are {} rows of positions and {} of velocities for {} times; give one for each",
                                 positions.size(), velocities.size(), moments.size()));
  for (std::size_t i = 0; i < moments.size(); ++i) {
    trajectory.points.emplace_back();
    trajectory.points.back().time_from_start = moments[i];
    trajectory.points.back().positions = positions[i];
    if (!velocities.empty()) trajectory.points.back().velocities = velocities[i];
  }
  change([&] { simulator_->commandTrajectory(index, trajectory); });
}

void Simulation::setJointPositions(const std::string& robot, const py::object& positions, const py::object& joints) {
  const int index = robotOf(*simulator_, robot);
  const std::vector<std::string> names = jointsOf(simulator_->robots()[static_cast<std::size_t>(index)], joints);
  const std::vector<double> numbers = oneForEach(positions, "positions", names.size());
  change([&] { simulator_->setJointPositions(index, names, numbers); });
}

int Simulation::worldJoint(const std::string& name) const {
  const sim::JointPart part = sim::findJoint(*simulator_, name, "joint");
  return simulator_->robots()[static_cast<std::size_t>(part.robot)].joints[static_cast<std::size_t>(part.joint)];
}

int Simulation::bodyIndex(const std::string& name) const {
  const sim::LinkPart part = sim::findLink(*simulator_, name, "body");
  if (part.body == dynamics::WORLD_BODY) throw InputError(fmt::format("body: '{}' cannot move; name one of body_names", name));
  return part.body;
}

void Simulation::applyEffort(const std::string& joint, double effort, double duration) {
  change([&] { simulator_->applyEffort(worldJoint(joint), effort, timeOf(duration)); });
}

void Simulation::applyWrench(const std::string& body, const sim::BodyLoad& load, double duration) {
  const sim::LinkPart part = sim::findLink(*simulator_, body, "body");
  sim::BodyLoad placed = load;
  placed.body = bodyIndex(body);
  placed.p_B = part.X_BL * load.p_B;
  change([&] { simulator_->applyLoad(placed, timeOf(duration)); });
}

void Simulation::clearEfforts(const std::string& joint) {
  change([&] { simulator_->clearEfforts(worldJoint(joint)); });
}

void Simulation::clearWrenches(const std::string& body) {
  change([&] { simulator_->clearLoads(bodyIndex(body)); });
}

std::unique_ptr<SimulationClearance> Simulation::clearance(const std::string& robot) {
  const ThreadTurn turn(&turn_);
  return std::make_unique<SimulationClearance>(sim::RobotClearance(*simulator_, robotOf(*simulator_, robot)));
}

}  // namespace blem_sim::python
