// All live environments of the node.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <vector>

#include "clouds/live_cloud.h"
#include "loop/simulation_loop.h"
#include "sending/step_publisher.h"

namespace blem_sim::node {

/**
 * Receives clouds beside the steps and exchanges environments for them between steps: while the simulation runs after each step, for calls
 * of `~step` and `~step_with_commands` once, before their first step and after all messages received so far are built. Publishes
 * `~live_cloud_updates`.
 */
class LiveClouds : public StepPublisher {
 public:
  /** [s] of wall time for which a call of `~step` waits for surfaces. */
  static constexpr int LONGEST_WAIT = 30;

  /** @param node of the topics @param loop exchanges the environments */
  LiveClouds(const ros::NodeHandle& node, ros::NodeHandle private_node, SimulationLoop* loop);
  ~LiveClouds() override;

  void publish(const sim::StepReport& report) override { time_ = report.time; }
  void timeRestarted() override;
  /** Counts of messages, and why the last one was refused. */
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  void takeUpdates(bool wait);
  void exchange(LiveCloud* cloud, BuiltCloud* built);
  void waitUntilBuilt();
  LiveCloud::Neighbours neighboursOf(const LiveCloud& cloud) const;
  void tellChanges();

  SimulationLoop& loop_;
  std::atomic<double> time_;  // [s] simulated
  CloudFrames frames_;
  std::vector<std::unique_ptr<LiveCloud>> clouds_;
  ros::CallbackQueue callbacks_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher updates_;
  ros::AsyncSpinner receiver_;
  std::chrono::steady_clock::time_point next_telling_;
  bool untold_ = false;
};

}  // namespace blem_sim::node
