#include "services/learner_service.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/sensor_values.h"
#include "messages/conversions.h"
#include "messages/joint_messages.h"
#include "messages/model_states.h"
#include "messages/status_text.h"

namespace blem_sim::node {

LearnerService::LearnerService(const ros::NodeHandle& private_node, SimulationLoop* loop)
    : loop_(loop), simulator_(loop->simulator()), services_(private_node) {
  auto readings = std::make_unique<LatestReadings>(simulator_);
  readings_ = readings.get();
  loop_->add(std::move(readings));
  services_.add<StepWithCommands>("step_with_commands", [this](const auto& request, auto* response) {
    command(request);
    readings_->keep();
    readings_->takeStatus();
    const std::uint32_t made = loop_->stepPaused(request.steps);
    response->status = readings_->takeStatus();
    observe(response);
    response->success = made == request.steps && (response->status & sim::STATE_NOT_FINITE) == 0;
    if (!response->success) response->status_message = stoppedText(made, request.steps, response->status);
  });
}

void LearnerService::command(const StepWithCommands::Request& request) {
  StampedCommands& stamped = *loop_->stampedCommands();
  const auto stampOf = [](const RobotCommand& c) { return c.command.header.stamp.toSec(); };
  for (const RobotCommand& c : request.commands) stamped.check(robotOf(c), commandOf(c.command), stampOf(c));
  for (const RobotCommand& c : request.commands) stamped.give(robotOf(c), commandOf(c.command), stampOf(c));
}

int LearnerService::robotOf(const RobotCommand& command) const {
  if (command.robot.empty() && simulator_.robots().size() == 1) return 0;
  const int robot = simulator_.robotIndex(command.robot);
  if (robot >= 0) return robot;
  std::string known;
  for (const sim::RobotInfo& info : simulator_.robots()) known += (known.empty() ? "" : ", ") + info.name;
  throw InputError(fmt::format("commands: robot: there is no robot '{}'; name one of: {}", command.robot, known));
}

void LearnerService::observe(StepWithCommands::Response* response) const {
  response->step = simulator_.steps();
  response->stamp = toStamp(simulator_.time());
  response->status_names = statusNames(response->status);
  response->state_hash = simulator_.stateHash();
  for (std::size_t robot = 0; robot < simulator_.robots().size(); ++robot)
    response->robots.push_back(observationOf(static_cast<int>(robot)));
  appendModels(simulator_, simulator_.report(), &response->models);
}

RobotObservation LearnerService::observationOf(int robot) const {
  const sim::RobotInfo& info = simulator_.robots()[static_cast<std::size_t>(robot)];
  RobotObservation observation;
  observation.robot = info.name;
  observation.joints = statesOf(info);
  writeStates(simulator_.report(), info, &observation.joints);
  for (const sim::SensorInfo& sensor : simulator_.sensors())
    if (sensor.robot == robot) observation.sensors.push_back(observationOf(sensor));
  return observation;
}

ObservedSensor LearnerService::observationOf(const sim::SensorInfo& sensor) const {
  ObservedSensor observed;
  observed.sensor = sensor.config.name;
  const LatestReadings::Reading* last = readings_->of(sensor);
  if (!last) return observed;
  observed.stamp = toStamp(last->time);
  sim::SensorValues row = sim::sensorValues(last->reading);
  observed.fields = std::move(row.names);
  observed.values = std::move(row.values);
  return observed;
}

}  // namespace blem_sim::node
