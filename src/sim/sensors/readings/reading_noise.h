// Noise and bias of a sensor's readings.
#pragma once

#include <array>
#include <vector>

#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/sim/config.h"
#include "blem_sim/sim/step_report.h"
#include "numbers/random_numbers.h"

namespace blem_sim::sim {

/** Adds to each number white noise, and a bias of its own, which walks from where it was drawn. */
class ReadingNoise {
 public:
  /** @param blank reading of the sensor, with as many numbers as others will have */
  ReadingNoise(const SensorNoise& noise, SensorReading blank);

  /** @param period [s] between two readings, on average */
  void add(double period, RandomNumbers* random, SensorReading* reading);
  /** Forgets the biases, which are drawn again. */
  void reset();

  /** Saves the biases; nothing if there are none. */
  void save(geometry::StateWriter* writer) const;
  void restore(geometry::StateReader* reader);

 private:
  void drawBiases(RandomNumbers* random);

  struct Quantity {
    QuantityNoise noise;
    std::vector<double> biases;  ///< of each of its numbers; none if they have no bias
  };
  std::array<Quantity, 2> quantities_;
  bool draws_ = false, drawn_ = false;  // constant biases
  std::vector<double*> numbers_;        // of a quantity
};

}  // namespace blem_sim::sim
