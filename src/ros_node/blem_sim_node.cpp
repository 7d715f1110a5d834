// The simulation server. Exit codes: 0 shut down, 2 bad input.
#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/param.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "loop/checkpoint.h"
#include "sending/poll_rounds.h"
#include "simulation_node.h"

namespace {
/** Ends the node between two steps, with its files whole. roscpp does so for SIGINT; docker, systemd, clusters and kill send SIGTERM. */
void endBetweenSteps(int) {
  blem_sim::node::keepCheckpoints();  // a cluster that takes its machine back starts the node again
  ros::requestShutdown();
}

/** Ends the program even if a thread, which may make a surface of a large cloud, takes longer. All files are whole by then. */
void endSoon() {
  std::thread([] {
    std::this_thread::sleep_for(std::chrono::seconds(2));
    std::_Exit(0);
  }).detach();
}
}  // namespace

int main(int argc, char** argv) {
  try {
    ros::init(argc, argv, "blem_sim");
  } catch (const std::exception& error) {
    ROS_FATAL("command line: %s; use letters, digits, _ and / in the node's name and in remappings, a letter first", error.what());
    return 2;
  }
  blem_sim::node::PollRounds::instance().watchBegin();
  // The parameter is set before the node starts its own clock, which asks for it.
  if (!ros::param::has("/use_sim_time")) ros::param::set("/use_sim_time", true);
  // roscpp ends with its last handle, and its log with it: this handle keeps it until the error line is out.
  const ros::NodeHandle handle;
  try {
    blem_sim::node::SimulationNode node;
    std::signal(SIGTERM, endBetweenSteps);  // not earlier: nothing is lost while it loads
    node.run();
    endSoon();
  } catch (const std::exception& error) {
    if (ros::isShuttingDown()) return 0;  // it was told to end while it started, and roscpp gave it nothing any more
    ROS_FATAL("%s", error.what());
    ros::shutdown();
    return 2;
  }
  return 0;
}
