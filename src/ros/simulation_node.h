#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <memory>

namespace blem_sim::node {

/** The simulation behind its ROS names. Everything but the transport runs in the thread that calls run(). */
class SimulationNode {
 public:
  /** Reads the parameters, loads everything, advertises. @throws InputError */
  SimulationNode();
  ~SimulationNode();

  /** Runs until the node is shut down. */
  void run();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace blem_sim::node
