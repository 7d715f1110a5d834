// Readings and status bits kept for a service's answer.
#pragma once

#include <map>
#include <string>

#include "sending/step_publisher.h"

namespace blem_sim {

/** Each sensor's last reading, and the status of the steps since it was taken. Keeps nothing until keep() is called. */
class LatestReadings : public StepPublisher {
 public:
  struct Reading {
    double time = 0;  ///< [s] simulated
    SensorReading reading;
  };

  explicit LatestReadings(const Simulator& simulator) : simulator_(simulator) {}

  void keep();
  /** StepStatus bits that were set since the last call. */
  std::uint32_t takeStatus();
  /** Null before the sensor's first reading. */
  const Reading* of(const SensorInfo& sensor) const;

  void publish(const StepReport& report) override;
  void timeRestarted() override { readings_.clear(); }
  void modelsChanged() override;

 private:
  std::string keyOf(const SensorInfo& sensor) const;

  const Simulator& simulator_;
  bool keeps_ = false;
  std::uint32_t status_ = STEP_OK;
  std::map<std::string, Reading> readings_;  // by the sensor's robot and name
};

}  // namespace blem_sim
