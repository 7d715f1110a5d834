// <plugin> by its file.
#pragma once

#include <string>

#include "blem_sim/sim/config.h"
#include "gazebo/gazebo_reader.h"

namespace blem_sim::sim {

/** A sensor as its <sensor> and its <plugin> say. */
struct GazeboSensor {
  SensorConfig config;
  std::string name_space;  ///< of its topics, <robotNamespace>; empty: the robot's
};

/** A kind of <plugin> that gives a sensor its topic, or makes one. */
struct GazeboPluginType {
  const char* name;  ///< of its file, without lib and .so
  SensorType type;
  bool inside;  ///< stands in a <sensor>
  void (*read)(GazeboReader*, GazeboSensor*);
};
/** Null if the file is not known. */
const GazeboPluginType* gazeboPluginType(const std::string& filename);
/** "gazebo_ros_p3d" of "libgazebo_ros_p3d.so" */
std::string pluginName(const std::string& filename);

}  // namespace blem_sim::sim
