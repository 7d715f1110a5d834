// A sensor's reading as a row of numbers, for statistics and tables.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/sim/simulator.h"

namespace blem_sim::sim {

struct SensorValues {
  std::vector<std::string> names;  ///< force_x, ...
  std::vector<double> values;
};

/** Numbers of a reading, with their names. Does not compile until it knows every kind of reading. */
SensorValues sensorValues(const SensorReading& reading);

/** A reading of a type of sensor that holds nothing yet. @param joints of its robot */
SensorReading blankReading(SensorType type, const std::vector<std::string>& joints);

/** Whether a sensor's samples hold the truth beside the reading: it has noise, a bias, limits or a delay. */
bool hasGroundTruth(const SensorConfig& sensor);

/** Topic of a sensor's readings, in its robot's namespace unless it begins with /. */
inline const std::string& sensorTopic(const SensorConfig& sensor) { return sensor.topic.empty() ? sensor.name : sensor.topic; }

/** Names of the fields of a sensor's readings, known before the first one. */
std::vector<std::string> sensorFields(const Simulator& simulator, const SensorInfo& sensor);

/** Names for a report: the sensor's own, "robot::name" where two robots have one of the same name. */
std::vector<std::string> sensorNames(const Simulator& simulator);

}  // namespace blem_sim::sim
