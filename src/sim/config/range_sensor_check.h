// Sound settings of depth cameras and lidars.
#pragma once

#include <optional>
#include <string>

#include "blem_sim/sim/config.h"

namespace blem_sim::sim {

/** A setting that cannot be used. */
struct ConfigFault {
  std::string key, why;  ///< as in the YAML; with the cure
};

/** First fault of a sensor's rays; nothing for sensors without any. */
std::optional<ConfigFault> faultOf(SensorType type, const RangeSensorConfig& rays);

}  // namespace blem_sim::sim
