// The controllers of one robot: which there are, and which of them runs.
#pragma once

#include <blem_sim/ControllerState.h>
#include <ros/node_handle.h>

#include <memory>
#include <string>
#include <vector>

#include "controllers/controller_server.h"
#include "loop/simulation_loop.h"

namespace blem_sim::node {

/** A change of the controllers that run. */
struct ControllerChange {
  std::vector<std::string> start, stop;
  bool strict = true;  ///< all or nothing
};

/**
 * Controllers of the configuration, and those loaded later. A joint obeys one controller at a time. Without a configuration one controller
 * of all joints runs, which gives way to others that are started.
 */
class RobotControllers {
 public:
  /** @throws InputError: wrong settings of a controller */
  RobotControllers(ros::NodeHandle node, SimulationLoop* loop, int robot);

  /** To be called after each step. @param time [s] simulated */
  void step(double time);
  void restartTime();

  const ros::NodeHandle& node() const { return node_; }  ///< in the robot's namespace

  /** Types that can be loaded. */
  static const std::vector<std::string>& types();
  std::vector<ControllerState> list() const;
  /** One that is there already stays. @throws InputError: its type on the parameter server is missing or not built in, wrong settings */
  void load(const std::string& name);
  /** @throws InputError: it is not there, or runs */
  void unload(const std::string& name);
  /** @return what was left undone, in words @throws InputError: something cannot be done and the change is strict; nothing is done then */
  std::vector<std::string> change(const ControllerChange& change);

 private:
  struct Controller {
    std::string name, type;
    std::unique_ptr<ControllerServer> server;  ///< null: joint states, which are published anyway
    bool running = false, has_run = false;
    bool gives_way = false;  ///< the one of all joints that nobody asked for
  };

  void add(const sim::ControllerConfig& config, const std::string& type);
  void addConfigured(const sim::ControllerConfig& config);
  void startFirst();
  Controller* find(const std::string& name);
  std::vector<std::string> knownNames() const;
  /** Running controller, none of those being stopped, that has a joint of this one; null if there is none. */
  Controller* rivalOf(const Controller& controller, const std::vector<std::string>& stopping);
  /** Why a controller cannot be stopped or started; empty if it can. */
  std::string obstacleToStop(const std::string& name);
  std::string obstacleToStart(const std::string& name, const ControllerChange& change);
  void start(Controller* controller);
  void stop(Controller* controller);

  ros::NodeHandle node_;
  SimulationLoop* loop_;
  sim::Simulator* simulator_;
  std::string robot_;
  std::vector<Controller> controllers_;
};

}  // namespace blem_sim::node
