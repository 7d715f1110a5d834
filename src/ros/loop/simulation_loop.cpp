#include "loop/simulation_loop.h"

#include <fmt/format.h>
#include <ros/console.h>
#include <ros/init.h>
#include <time.h>

#include <algorithm>

#include "blem_sim/geometry/input_error.h"
#include "messages/status_text.h"

namespace blem_sim::node {

namespace {
// Longest wait for a callback, so that a shutdown and the 1 Hz diagnostics are noticed during a pause.
constexpr double LONGEST_WAIT = 0.05;  // [s]
// Steps made without a look at the sockets; below the publishers' queue lengths, so that no message of a batch is dropped.
constexpr std::uint32_t STEPS_PER_FLUSH = 50;
// Largest block [bytes] for messages that are read by others, such as goals of actions.
constexpr std::size_t LARGEST_BLOCK = 1u << 30;

/** Processor time [s] of this thread. */
double threadSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

StepPacer pacerOf(const sim::SimulationConfig& config) { return {config.real_time_factor, config.time_step, config.busy_wait}; }

}  // namespace

SimulationLoop::SimulationLoop(sim::Simulator* simulator)
    : simulator_(simulator), pacer_(pacerOf(simulator->config())), stamped_commands_(simulator), paused_(simulator->config().paused) {}

void SimulationLoop::publish(const sim::StepReport& report) {
  const StepPacer::Clock::time_point start = StepPacer::Clock::now();
  const double processor_start = threadSeconds();
  for (const auto& publisher : publishers_) publisher->publish(report);
  sender_.send();
  publishing_time_.processor += threadSeconds() - processor_start;
  publishing_time_.wall += std::chrono::duration<double>(StepPacer::Clock::now() - start).count();
}

bool SimulationLoop::step() {
  stamped_commands_.giveDue();
  const sim::StepReport& report = simulator_->step();
  publish(report);
  if ((report.status & sim::STATE_NOT_FINITE) == 0) return true;
  paused_ = true;
  ROS_ERROR("t = %.3f s: %s", report.time, statusAdvice(sim::STATE_NOT_FINITE).front().c_str());
  return false;
}

void SimulationLoop::run(ros::CallbackQueue* callbacks, const std::function<void(bool paused)>& serve) {
  publish(simulator_->report());
  for (const auto& publisher : publishers_) publisher->resumed();
  pacer_.restart(StepPacer::Clock::now());
  while (ros::ok()) {
    const double sleep = paused_ ? LONGEST_WAIT : std::min(LONGEST_WAIT, pacer_.sleep(StepPacer::Clock::now()));
    serveCallbacks(callbacks, sleep);
    serve(paused_);
    if (paused_ || pacer_.wait(StepPacer::Clock::now()) > 0) continue;
    if (!step()) continue;
    pacer_.stepped(StepPacer::Clock::now());
    actBeforeSteps(false);  // in the time until the next step is due
  }
}

void SimulationLoop::serveCallbacks(ros::CallbackQueue* callbacks, double wait) {
  const AllocationLimit limit(LARGEST_BLOCK);
  callbacks->callAvailable(ros::WallDuration(wait));
}

void SimulationLoop::actBeforeSteps(bool asked_for) {
  for (const auto& act : before_steps_) act(asked_for);
}

void SimulationLoop::unpause() {
  if (!paused_) return;
  paused_ = false;
  actBeforeSteps(false);
  pacer_.restart(StepPacer::Clock::now());
  for (const auto& publisher : publishers_) publisher->resumed();
}

std::uint32_t SimulationLoop::stepPaused(std::uint32_t count) {
  if (count > MOST_STEPS)
    throw InputError(fmt::format("steps: {} are too many for one call, during which the node hears nobody; make at most {} and call again",
                                 count, MOST_STEPS));
  paused_ = true;
  for (const auto& publisher : publishers_) publisher->resumed();
  if (count > 0) actBeforeSteps(true);
  std::uint32_t made = 0;
  bool finite = true;
  while (made < count && finite && ros::ok()) {
    finite = step();
    ++made;
    if (made % STEPS_PER_FLUSH == 0) flush();
  }
  flush();
  return made;
}

void SimulationLoop::drain() {
  for (const auto& publisher : publishers_) publisher->drain();
  sender_.drain();
}

void SimulationLoop::flush() {
  drain();
  outbox_.flush();
}

void SimulationLoop::resetSimulation() {
  drain();  // messages of earlier steps go out before those that are published directly
  stamped_commands_.clear();
  simulator_->resetSimulation();
  for (const auto& publisher : publishers_) publisher->timeRestarted();
  publish(simulator_->report());
}

void SimulationLoop::restore(const sim::SimulationState& state) {
  const double before = simulator_->time();
  simulator_->restore(state);
  stamped_commands_.clear();
  sender_.drain();
  if (simulator_->time() < before)
    for (const auto& publisher : publishers_) publisher->timeRestarted();
  publish(simulator_->report());
}

void SimulationLoop::paceChanged() {
  pacer_ = pacerOf(simulator_->config());
  for (const auto& act : on_pace_changed_) act();
}

void SimulationLoop::cloudsChanged() {
  for (const auto& publisher : publishers_) publisher->cloudsChanged();
}

void SimulationLoop::modelsChanged() {
  sender_.drain();  // messages in it are for publishers that may go
  for (const auto& act : on_models_changed_) act();
  for (const auto& publisher : publishers_) publisher->modelsChanged();
}

}  // namespace blem_sim::node
