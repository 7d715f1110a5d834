#include "sensors/readings/reading_noise.h"

#include <algorithm>
#include <cmath>

#include "sensors/readings/reading_numbers.h"

namespace blem_sim::sim {

ReadingNoise::ReadingNoise(const SensorNoise& noise, SensorReading blank) {
  const bool is_imu = std::holds_alternative<ImuReading>(blank);  // its biases are part of every state
  for (std::size_t q = 0; q < quantities_.size(); ++q) {
    quantities_[q].noise = noise[q];
    draws_ = draws_ || noise[q].bias != 0 || noise[q].bias_spread > 0;
  }
  forEachNumber(&blank, [&](double&, int quantity) {
    if (quantity >= 0 && (is_imu || quantities_[quantity].noise.remembers())) quantities_[quantity].biases.push_back(0);
  });
}

void ReadingNoise::drawBiases(RandomNumbers* random) {
  if (!draws_ || drawn_) return;
  drawn_ = true;
  for (Quantity& quantity : quantities_)
    for (double& bias : quantity.biases)
      bias = quantity.noise.bias + (quantity.noise.bias_spread > 0 ? quantity.noise.bias_spread * random->gaussian() : 0);
}

void ReadingNoise::add(double period, RandomNumbers* random, SensorReading* reading) {
  drawBiases(random);
  for (std::size_t q = 0; q < quantities_.size(); ++q) {
    const QuantityNoise& noise = quantities_[q].noise;
    if (!noise.any()) continue;
    const double walk = noise.bias_stddev * std::sqrt(period);
    if (walk > 0)
      for (double& bias : quantities_[q].biases) bias += walk * random->gaussian();
    numbers_.clear();
    forEachNumber(reading, [&](double& number, int quantity) {
      if (quantity == static_cast<int>(q)) numbers_.push_back(&number);
    });
    if (noise.stddev > 0)
      for (double* number : numbers_) *number += noise.stddev * random->gaussian();
    for (std::size_t i = 0; i < quantities_[q].biases.size(); ++i) *numbers_[i] += quantities_[q].biases[i];
  }
}

void ReadingNoise::reset() {
  drawn_ = false;
  for (Quantity& quantity : quantities_) std::fill(quantity.biases.begin(), quantity.biases.end(), 0);
}

void ReadingNoise::save(geometry::StateWriter* writer) const {
  for (const Quantity& quantity : quantities_) writer->numbers(quantity.biases.data(), quantity.biases.size());
  if (draws_) writer->number(drawn_ ? 1 : 0);
}

void ReadingNoise::restore(geometry::StateReader* reader) {
  for (Quantity& quantity : quantities_) reader->numbers(quantity.biases.data(), quantity.biases.size());
  if (draws_) drawn_ = reader->choice(2) == 1;
}

}  // namespace blem_sim::sim
