// The controllers of all robots.
#pragma once

#include <ros/node_handle.h>

#include <map>
#include <memory>
#include <string>

#include "controllers/controller_services.h"
#include "controllers/robot_controllers.h"
#include "sending/step_publisher.h"

namespace blem_sim::node {

/** One set of controllers, and its services, for each robot that has its namespace to itself. */
class ControllerSets : public StepPublisher {
 public:
  /** @throws InputError: wrong settings of a controller */
  ControllerSets(ros::NodeHandle node, SimulationLoop* loop);

  void publish(const sim::StepReport& report) override;
  void timeRestarted() override;
  /** All messages about robots that went are out. @throws InputError: wrong settings of a controller */
  void modelsChanged() override;

 private:
  struct Set {
    std::string robot;
    std::unique_ptr<RobotControllers> controllers;
    std::unique_ptr<ControllerServices> services;
  };

  void add(int robot);

  ros::NodeHandle node_;
  SimulationLoop* loop_;
  sim::Simulator* simulator_;
  std::map<std::string, Set> sets_;  // by namespace
};

}  // namespace blem_sim::node
