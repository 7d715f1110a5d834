// Readings and status bits kept for a service's answer.
#pragma once

#include <map>
#include <string>

#include "sending/step_publisher.h"

namespace blem_sim::node {

/** Each sensor's last reading, and the status of the steps since it was taken. Keeps nothing until keep() is called. */
class LatestReadings : public StepPublisher {
 public:
  struct Reading {
    double time = 0;  ///< [s] simulated
    sim::SensorReading reading;
  };

  explicit LatestReadings(const sim::Simulator& simulator) : simulator_(simulator) {}

  void keep();
  /** StepStatus bits that were set since the last call. */
  std::uint32_t takeStatus();
  /** Null before the sensor's first reading. */
  const Reading* of(const sim::SensorInfo& sensor) const;

  void publish(const sim::StepReport& report) override;
  void timeRestarted() override { readings_.clear(); }
  void modelsChanged() override;

 private:
  std::string keyOf(const sim::SensorInfo& sensor) const;

  const sim::Simulator& simulator_;
  bool keeps_ = false;
  std::uint32_t status_ = sim::STEP_OK;
  std::map<std::string, Reading> readings_;  // by the sensor's robot and name
};

}  // namespace blem_sim::node
