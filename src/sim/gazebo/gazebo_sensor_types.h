// <sensor> by its type.
#pragma once

#include <string>

#include "blem_sim/sim/config.h"
#include "gazebo/gazebo_reader.h"

namespace blem_sim::sim {

/** A kind of <sensor>. */
struct GazeboSensorType {
  const char* name;
  SensorType type;
  double rate;  ///< [Hz] unless told otherwise; 0 = every step
  void (*read)(GazeboReader*, SensorConfig*);
};
/** Null if the type is not known. */
const GazeboSensorType* gazeboSensorType(const std::string& name);

}  // namespace blem_sim::sim
