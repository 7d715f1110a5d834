#include "controllers/controller_sets.h"

#include <ros/console.h>

#include <iterator>

namespace blem_sim::node {

ControllerSets::ControllerSets(ros::NodeHandle node, SimulationLoop* loop) : node_(node), loop_(loop), simulator_(&loop->simulator()) {
  modelsChanged();
}

void ControllerSets::modelsChanged() {
  for (auto set = sets_.begin(); set != sets_.end();)
    set = simulator_->robotIndex(set->second.robot) < 0 ? sets_.erase(set) : std::next(set);
  for (std::size_t robot = 0; robot < simulator_->robots().size(); ++robot) add(static_cast<int>(robot));
}

void ControllerSets::add(int robot) {
  const sim::RobotInfo& info = simulator_->robots()[robot];
  // The place of its services: "" and "/" are one, "arm" and "/arm/" are.
  const std::string place = ros::NodeHandle(node_, info.name_space).resolveName("controller_manager");
  const auto known = sets_.find(place);
  if (known != sets_.end()) {
    if (known->second.robot != info.name)
      ROS_WARN("robots: %s: has no controllers: those of %s have their names; set namespace", info.name.c_str(),
               known->second.robot.c_str());
    return;
  }
  auto controllers = std::make_unique<RobotControllers>(node_, loop_, robot);
  auto services = std::make_unique<ControllerServices>(controllers.get());
  sets_[place] = {info.name, std::move(controllers), std::move(services)};
}

void ControllerSets::publish(const sim::StepReport& report) {
  for (auto& [place, set] : sets_) set.controllers->step(report.time);
}

void ControllerSets::timeRestarted() {
  for (auto& [place, set] : sets_) set.controllers->restartTime();
}

}  // namespace blem_sim::node
