// The simulation's one thread: steps when they are due, tells the publishers, serves callbacks between steps.
#pragma once

#include <ros/callback_queue.h>

#include <functional>
#include <memory>
#include <vector>

#include "outbox.h"
#include "step_pacer.h"
#include "step_publisher.h"

namespace blem_sim {

class SimulationLoop {
 public:
  explicit SimulationLoop(Simulator* simulator);

  Simulator& simulator() { return *simulator_; }
  void add(std::unique_ptr<StepPublisher> publisher) { publishers_.push_back(std::move(publisher)); }

  /** Publishes the state at hand, then steps until the node is shut down. @param serve is called between steps with whether it is paused.
   */
  void run(ros::CallbackQueue* callbacks, const std::function<void(bool paused)>& serve);

  bool paused() const { return paused_; }
  void pause() { paused_ = true; }
  void unpause();

  /** Pauses, makes `count` steps and sees their messages off. @return how many were made: fewer if the node is shut down or a state
   *  stopped being finite */
  std::uint32_t stepPaused(std::uint32_t count);

  void resetWorld() { simulator_->resetWorld(); }
  void resetSimulation();
  /** An environment was loaded or unloaded. */
  void geometryChanged();

  /** [s] wall time that publishing took in this thread since the start. */
  double publishSeconds() const { return publish_seconds_; }

 private:
  /** False if the state stopped being finite: the simulation is paused then. */
  bool step();
  void publish(const StepReport& report);

  Simulator* simulator_;
  std::vector<std::unique_ptr<StepPublisher>> publishers_;
  StepPacer pacer_;
  Outbox outbox_;
  bool paused_;
  double publish_seconds_ = 0;
};

}  // namespace blem_sim
