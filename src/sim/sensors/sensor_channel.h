// A sensor and what lies between it and its reader: schedule, delay, noise, range and resolution.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sensors/delay_line.h"
#include "sensors/reading_noise.h"
#include "sensors/sensor.h"
#include "sensors/sensor_schedule.h"
#include "sensors/wrench_tare.h"

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
  bool readsContacts(std::uint64_t number) const {
    return sensor_->readsContacts() && (schedule_.due(number) || memory_.delay.steps() > 0);
  }

  /** Makes the sensor again, as its bodies are now. With another time step, readings on their way are lost. */
  void remake(const SimulatedWorld& world, const SensorInfo& info, double time_step);
  /** Forgets what the sensor remembers and what is on its way, without touching the random numbers. */
  void reset() { memory_.reset(); }

  /** Memory of a sensor from reading to reading. */
  struct Memory {
    ReadingNoise noise;
    DelayLine delay;
    WrenchTare tare;

    void reset();
    /** Appends all but the tare. */
    void append(std::vector<double>* numbers) const;
    void read(NumberReader* reader);
  };
  Memory& memory() { return memory_; }
  const Memory& memory() const { return memory_; }
  RandomNumbers& random() { return sensor_->random(); }
  const RandomNumbers& random() const { return sensor_->random(); }

 private:
  SensorConfig config_;
  bool has_truth_;
  std::unique_ptr<Sensor> sensor_;
  SensorSchedule schedule_;
  Memory memory_;
};

}  // namespace blem_sim::sim
