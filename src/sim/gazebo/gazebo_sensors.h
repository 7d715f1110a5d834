// Sensors of a robot's <gazebo> blocks.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"
#include "gazebo/gazebo_notes.h"
#include "gazebo/gazebo_plugin_types.h"

namespace blem_sim::sim {

/** Adds sensors to a robot's configuration, one by one. */
class GazeboSensors {
 public:
  GazeboSensors(const model::RobotModel& model, GazeboNotes* notes, RobotConfig* config)
      : model_(model), notes_(*notes), config_(*config) {}

  /** Reads the sensors and plugins in a <gazebo>. */
  void read(const model::GazeboBlock& gazebo);
  /** After all blocks: adds sensors without a plugin, of which Gazebo tells ROS nothing, so that they take nobody's topic. */
  void finish();

 private:
  void readSensor(const model::GazeboBlock& block);
  void readPlugin(const model::GazeboBlock& block);
  void readOtherPlugin(const model::GazeboBlock& block);
  void add(GazeboSensor sensor, const model::GazeboBlock& block);
  void nameTopics(GazeboSensor* sensor);
  void nameFrame(const GazeboReader& reader, SensorConfig* sensor);
  bool sitsSomewhere(const SensorConfig& sensor, const GazeboReader& reader) const;
  bool topicIsFree(const GazeboReader& reader, SensorConfig* sensor) const;
  std::string resolved(const std::string& topic) const;
  const SensorConfig* sensorNamed(const std::string& name) const;

  const model::RobotModel& model_;
  GazeboNotes& notes_;
  RobotConfig& config_;
  std::vector<std::pair<GazeboSensor, const model::GazeboBlock*>> plain_;  ///< without a plugin; blocks of the model
  std::size_t configured_ = config_.sensors.size();                        ///< sensors of the configuration, which come first
};

}  // namespace blem_sim::sim
