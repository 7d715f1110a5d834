#include "simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/state_file.h"
#include "thread_turn.h"

namespace py = pybind11;

namespace blem_sim::python {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds SIGNAL_PERIOD(100);  // after which a long call looks for Ctrl-C

std::size_t jointCount(const sim::Simulator& simulator) {
  std::size_t count = 0;
  for (const sim::RobotInfo& robot : simulator.robots()) count += robot.joints.size();
  return count;
}

std::vector<int> worldBodies(const sim::Simulator& simulator) {
  std::vector<int> bodies;
  for (const sim::ModelInfo& model : simulator.models())
    for (const int body : model.bodies)
      if (model.alive && body != dynamics::WORLD_BODY) bodies.push_back(body);
  return bodies;
}

}  // namespace

Simulation::Simulation(std::unique_ptr<sim::Simulator> simulator)
    : simulator_(std::move(simulator)),
      bodies_(worldBodies(*simulator_)),
      rows_(simulator_->report().bodies.size(), -1),
      readings_(simulator_->sensors().size()),
      positions_(jointCount(*simulator_), 0),
      velocities_(jointCount(*simulator_), 0),
      efforts_(jointCount(*simulator_), 0),
      poses_(bodies_.size(), 7),
      body_velocities_(bodies_.size(), 6) {
  for (const sim::RobotInfo& robot : simulator_->robots()) {
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      joint_names_.push_back(robot.name + "::" + robot.joint_names[j]);
      joints_.push_back(robot.joints[j]);
    }
  }
  for (std::size_t row = 0; row < bodies_.size(); ++row) {
    body_names_.push_back(simulator_->bodyName(bodies_[row]));
    rows_[static_cast<std::size_t>(bodies_[row])] = static_cast<int>(row);
  }
  show();
}

void Simulation::stepWhileAllowed(std::int64_t count) {
  const py::gil_scoped_release others_go_on;
  Clock::time_point looked = Clock::now();
  for (std::int64_t i = 0; i < count; ++i) {
    const sim::StepReport& report = simulator_->step();
    status_ |= report.status;
    for (const sim::SensorSample& sample : report.samples) readings_[static_cast<std::size_t>(sample.sensor)] = sample.reading;
    if (report.status & sim::STATE_NOT_FINITE) return;
    if (Clock::now() - looked < SIGNAL_PERIOD) continue;
    looked = Clock::now();
    const py::gil_scoped_acquire interpreter;
    if (PyErr_CheckSignals() != 0) return;
  }
}

void Simulation::step(std::int64_t count) {
  if (count < 0) throw InputError(fmt::format("step: {} steps cannot be made; give 0 or more", count));
  const ThreadTurn turn(&turn_);
  status_ = 0;
  stepWhileAllowed(count);
  show();
  if (PyErr_Occurred()) throw py::error_already_set();
}

void Simulation::show() {
  const sim::StepReport& report = simulator_->report();
  for (std::size_t row = 0; row < joints_.size(); ++row) {
    const dynamics::JointState& state = report.joints[static_cast<std::size_t>(joints_[row])];
    positions_.data()[row] = state.position;
    velocities_.data()[row] = state.velocity;
    efforts_.data()[row] = state.effort;
  }
  showBodies();
}

void Simulation::showBodies() {
  for (std::size_t row = 0; row < bodies_.size(); ++row) {
    const dynamics::BodyState& state = simulator_->report().bodies[static_cast<std::size_t>(bodies_[row])];
    const Vector3 com_from_origin = state.X_WB.linear() * simulator_->world().bodySpec(bodies_[row]).inertial.com;
    const Vector3 velocity = state.v_WCom - state.w_WB.cross(com_from_origin);
    const Quaternion turn(state.X_WB.linear());
    double* pose = poses_.data() + 7 * row;
    std::copy_n(state.X_WB.translation().data(), 3, pose);
    std::copy_n(turn.coeffs().data(), 4, pose + 3);
    double* velocities = body_velocities_.data() + 6 * row;
    std::copy_n(velocity.data(), 3, velocities);
    std::copy_n(state.w_WB.data(), 3, velocities + 3);
  }
}

void Simulation::change(const std::function<void()>& call) {
  const ThreadTurn turn(&turn_);
  call();
  show();
}

void Simulation::reset() {
  change([&] {
    simulator_->resetSimulation();
    std::fill(readings_.begin(), readings_.end(), std::nullopt);
    status_ = 0;
  });
}

py::bytes Simulation::save() {
  const ThreadTurn turn(&turn_);
  return sim::stateBytes(simulator_->save());
}

void Simulation::restore(const py::bytes& state) {
  const sim::SimulationState read = sim::stateOf(state, "state");
  change([&] {
    simulator_->restore(read);
    std::fill(readings_.begin(), readings_.end(), std::nullopt);
    status_ = 0;
  });
}

std::string Simulation::stateHash() {
  const ThreadTurn turn(&turn_);
  return fmt::format("{:016x}", simulator_->stateHash());
}

double Simulation::time() {
  const ThreadTurn turn(&turn_);
  return simulator_->time();
}

std::uint64_t Simulation::steps() {
  const ThreadTurn turn(&turn_);
  return simulator_->steps();
}

double Simulation::timeStep() {
  const ThreadTurn turn(&turn_);
  return simulator_->config().time_step;
}

double Simulation::energy() {
  const ThreadTurn turn(&turn_);
  return simulator_->report().energy;
}

std::vector<std::string> Simulation::status() const {
  std::vector<std::string> names;
  for (const sim::StatusBit& bit : sim::STEP_STATUS)
    if (status_ & bit.bit) names.emplace_back(bit.name);
  return names;
}

}  // namespace blem_sim::python
