// Sensors of a robot's <gazebo> blocks.
#pragma once

#include <string>

#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"
#include "gazebo/gazebo_notes.h"
#include "gazebo/gazebo_plugin_types.h"

namespace blem_sim {

/** Adds sensors to a robot's configuration, one by one. */
class GazeboSensors {
 public:
  GazeboSensors(const RobotModel& model, GazeboNotes* notes, RobotConfig* config) : model_(model), notes_(*notes), config_(*config) {}

  /** Reads the sensors and plugins in a <gazebo>. */
  void read(const GazeboBlock& gazebo);

 private:
  void readSensor(const GazeboBlock& block);
  void readPlugin(const GazeboBlock& block);
  void readOtherPlugin(const GazeboBlock& block);
  void add(GazeboSensor sensor, const GazeboBlock& block);
  void nameTopics(GazeboSensor* sensor);
  void nameFrame(const GazeboReader& reader, SensorConfig* sensor);
  bool sitsSomewhere(const SensorConfig& sensor, const GazeboReader& reader) const;
  bool topicIsFree(const GazeboReader& reader, SensorConfig* sensor) const;
  std::string resolved(const std::string& topic) const;
  const SensorConfig* sensorNamed(const std::string& name) const;

  const RobotModel& model_;
  GazeboNotes& notes_;
  RobotConfig& config_;
  std::size_t configured_ = config_.sensors.size();  ///< sensors of the configuration, which come first
};

}  // namespace blem_sim
