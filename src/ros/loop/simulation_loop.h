// The simulation's one thread: steps when they are due, tells the publishers, serves callbacks between steps.
#pragma once

#include <ros/callback_queue.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "loop/refusals.h"
#include "loop/root_frames.h"
#include "loop/stamped_commands.h"
#include "loop/step_pacer.h"
#include "sending/outbox.h"
#include "sending/step_publisher.h"
#include "sending/step_sender.h"

namespace blem_sim::node {

/** Most steps that one call may ask for: the node hears nobody while it makes them. */
constexpr std::uint32_t MOST_STEPS = 1000000;

/** Time [s] of publishing in the stepping thread since the start. */
struct PublishingTime {
  double wall = 0;
  double processor = 0;  ///< without waiting, and without the time of other threads and programs
};

class SimulationLoop {
 public:
  explicit SimulationLoop(sim::Simulator* simulator);

  sim::Simulator& simulator() { return *simulator_; }
  void add(std::unique_ptr<StepPublisher> publisher) { publishers_.push_back(std::move(publisher)); }

  /** Publishes the state at hand, then steps until the node is shut down. @param serve is called between steps with whether it is paused.
   */
  void run(ros::CallbackQueue* callbacks, const std::function<void(bool paused)>& serve);

  bool paused() const { return paused_; }
  void pause() { paused_ = true; }
  void unpause();

  /** Pauses, makes `count` steps and sees their messages off. @return number of steps made: fewer if the node is shut down or a state
   *  stopped being finite @throws InputError: more than MOST_STEPS, while which the node would hear nobody */
  std::uint32_t stepPaused(std::uint32_t count);

  void resetWorld() {
    stamped_commands_.clear();
    simulator_->resetWorld();
  }
  void resetSimulation();
  /** Goes on from a saved state; if that lies back in time, time has started again for the publishers. @throws InputError */
  void restore(const sim::SimulationState& state);
  /** Models came or went. @throws InputError: a name of theirs clashes */
  void modelsChanged();
  /** Lets an action follow on every change of models. */
  void onModelsChanged(std::function<void()> act) { on_models_changed_.push_back(std::move(act)); }
  /** Lets an action take place between steps: after each while the simulation runs, in the time until the next one is due, and when it
   *  goes on (with false); once before those that stepPaused makes (with true: what was sent before shall count). */
  void beforeSteps(std::function<void(bool asked_for)> act) { before_steps_.push_back(std::move(act)); }
  /** Live environments were exchanged. */
  void cloudsChanged();
  /** The time step or the real-time factor was set. */
  void paceChanged();
  void onPaceChanged(std::function<void()> act) { on_pace_changed_.push_back(std::move(act)); }

  /** Sender for the messages of every step's publishers. */
  StepSender* sender() { return &sender_; }

  /** Commands that wait for their steps. */
  StampedCommands* stampedCommands() { return &stamped_commands_; }
  /** Robots that drives have in the frames of their odometry. */
  RootFrames* rootFrames() { return &root_frames_; }
  /** Counts of refused messages. */
  Refusals* refusals() { return &refusals_; }

  const PublishingTime& publishingTime() const { return publishing_time_; }

 private:
  void serveCallbacks(ros::CallbackQueue* callbacks, double wait);
  /** Makes a step. False if the state stopped being finite: the simulation is paused then. */
  bool step();
  void actBeforeSteps(bool asked_for);
  void publish(const sim::StepReport& report);
  /** Returns when the messages published so far have been offered to the sockets. */
  void flush();
  void drain();

  sim::Simulator* simulator_;
  RootFrames root_frames_;  // before the publishers, which use it
  std::vector<std::unique_ptr<StepPublisher>> publishers_;
  std::vector<std::function<void()>> on_models_changed_, on_pace_changed_;
  std::vector<std::function<void(bool)>> before_steps_;
  StepPacer pacer_;
  Outbox outbox_;
  Refusals refusals_;
  StampedCommands stamped_commands_;
  bool paused_;
  PublishingTime publishing_time_;
  StepSender sender_;  // last: its messages need the publishers
};

}  // namespace blem_sim::node
