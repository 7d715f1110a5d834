#include "services/sensor_services.h"

#include <std_srvs/Trigger.h>

#include <boost/function.hpp>

#include "blem_sim/sim/sensor_values.h"

namespace blem_sim::node {

SensorServices::SensorServices(ros::NodeHandle node, sim::Simulator* simulator) : node_(node), simulator_(simulator) { modelsChanged(); }

void SensorServices::modelsChanged() {
  std::map<Names, ros::ServiceServer> servers;
  for (const sim::SensorInfo& sensor : simulator_->sensors()) {
    if (sensor.config.type != sim::SensorType::FORCE_TORQUE) continue;
    const Names names(simulator_->robots()[sensor.robot].name, sensor.config.name);
    const auto known = tares_.find(names);
    servers[names] = known != tares_.end() ? known->second : advertiseTare(sensor, names);
  }
  tares_.swap(servers);
}

ros::ServiceServer SensorServices::advertiseTare(const sim::SensorInfo& sensor, const Names& names) {
  ros::NodeHandle robot_node(node_, simulator_->robots()[sensor.robot].name_space);
  const boost::function<bool(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&)> tare =
      [this, names](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
        const auto& sensors = simulator_->sensors();
        for (std::size_t i = 0; i < sensors.size(); ++i)
          if (Names(simulator_->robots()[sensors[i].robot].name, sensors[i].config.name) == names)
            simulator_->tareSensor(static_cast<int>(i));
        response.success = true;
        response.message = "what " + names.second + " measures next is its zero";
        return true;
      };
  return robot_node.advertiseService<std_srvs::Trigger::Request, std_srvs::Trigger::Response>(sim::sensorTopic(sensor.config) + "/tare",
                                                                                              tare);
}

}  // namespace blem_sim::node
