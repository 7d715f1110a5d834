// A sensor and what lies between it and its reader: schedule, delay, noise, range and resolution.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sensors/readings/delay_line.h"
#include "sensors/readings/reading_noise.h"
#include "sensors/readings/sensor_schedule.h"
#include "sensors/readings/wrench_tare.h"
#include "sensors/types/sensor.h"

namespace blem_sim::sim {

class SensorChannel {
 public:
  /** @param time_step [s] */
  SensorChannel(const SimulatedWorld& world, const SensorInfo& info, double time_step);

  /**
   * Lets the sensor see a step.
   * @param number of the step, from 1
   * @param out its reading, and the truth if there is noise or the like; memory of earlier readings in it is used again
   * @return false: there is no reading at this step
   */
  bool read(const StepContext& step, std::uint64_t number, SensorSample* out);
  /** Whether read() will need the contacts of that step. */
  bool readsContacts(std::uint64_t number) const { return sensor_->readsContacts() && (schedule_.due(number) || delay_.steps() > 0); }

  /** Makes the sensor again, as its bodies are now. With another time step, readings on their way are lost. */
  void remake(const SimulatedWorld& world, const SensorInfo& info, double time_step);
  /** Forgets what the sensor remembers and what is on its way, without touching the random numbers. */
  void reset();

  RandomNumbers& random() { return sensor_->random(); }
  WrenchTare& tare() { return tare_; }
  const WrenchTare& tare() const { return tare_; }
  /** Saves what the sensor remembers but its tare, its random numbers and the readings that are on their way. */
  void save(geometry::StateWriter* writer) const;
  void restore(geometry::StateReader* reader);

 private:
  SensorConfig config_;
  bool has_truth_;
  std::unique_ptr<Sensor> sensor_;
  SensorSchedule schedule_;
  ReadingNoise noise_;
  DelayLine delay_;
  WrenchTare tare_;
};

}  // namespace blem_sim::sim
