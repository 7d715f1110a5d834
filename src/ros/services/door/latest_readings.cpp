#include "services/door/latest_readings.h"

#include <utility>

namespace blem_sim::node {

void LatestReadings::keep() {
  if (std::exchange(keeps_, true)) return;
  publish(simulator_.report());
}

std::uint32_t LatestReadings::takeStatus() { return std::exchange(status_, sim::STEP_OK); }

const LatestReadings::Reading* LatestReadings::of(const sim::SensorInfo& sensor) const {
  const auto found = readings_.find(keyOf(sensor));
  return found == readings_.end() ? nullptr : &found->second;
}

void LatestReadings::publish(const sim::StepReport& report) {
  if (!keeps_) return;
  status_ |= report.status;
  for (const sim::SensorSample& sample : report.samples)
    readings_[keyOf(simulator_.sensors()[static_cast<std::size_t>(sample.sensor)])] = {report.time, sample.reading};
}

void LatestReadings::modelsChanged() {
  std::map<std::string, Reading> kept;
  for (const sim::SensorInfo& sensor : simulator_.sensors())
    if (const Reading* reading = of(sensor)) kept[keyOf(sensor)] = *reading;
  readings_.swap(kept);
}

std::string LatestReadings::keyOf(const sim::SensorInfo& sensor) const {
  return simulator_.robots()[static_cast<std::size_t>(sensor.robot)].name + "::" + sensor.config.name;
}

}  // namespace blem_sim::node
