#include "last_readings.h"

#include <algorithm>
#include <limits>

#include "blem_sim/sim/sensor_values.h"

namespace blem_sim {

LastReadings::LastReadings(const sim::Simulator& simulator) {
  const std::vector<std::string> sensors = sim::sensorNames(simulator);
  for (std::size_t sensor = 0; sensor < sensors.size(); ++sensor) {
    firsts_.push_back(names_.size());
    for (const std::string& field : sim::sensorFields(simulator, simulator.sensors()[sensor]))
      names_.push_back(sensors[sensor] + '.' + field);
  }
  values_.assign(names_.size(), std::numeric_limits<double>::quiet_NaN());
}

void LastReadings::add(const sim::StepReport& report) {
  for (const sim::SensorSample& sample : report.samples) {
    const std::vector<double> values = sim::sensorValues(sample.reading).values;
    std::copy(values.begin(), values.end(),
              values_.begin() + static_cast<std::ptrdiff_t>(firsts_[static_cast<std::size_t>(sample.sensor)]));
  }
}

}  // namespace blem_sim
