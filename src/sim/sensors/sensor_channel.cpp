#include "sensors/sensor_channel.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "blem_sim/sim/sensor_values.h"
#include "sensors/readings/reading_numbers.h"

namespace blem_sim::sim {
namespace {

/** A whole number of steps of the resolution within the range, which its ends are not beyond. */
double limited(double value, const QuantityLimits& limits) {
  if (limits.resolution == 0) return std::clamp(value, -limits.saturation, limits.saturation);
  const double most = std::floor(limits.saturation / limits.resolution * (1 + 1e-12));
  return limits.resolution * std::clamp(std::round(value / limits.resolution), -most, most);
}

void limit(const SensorLimits& limits, SensorReading* reading) {
  forEachNumber(reading, [&](double& number, int quantity) {
    if (quantity >= 0) number = limited(number, limits[static_cast<std::size_t>(quantity)]);
  });
}

SensorReading blankOf(const SimulatedWorld& world, const SensorInfo& info) {
  return blankReading(info.config.type, world.robots[info.robot].joint_names);
}

}  // namespace

SensorChannel::SensorChannel(const SimulatedWorld& world, const SensorInfo& info, double time_step)
    : config_(info.config),
      has_truth_(hasGroundTruth(info.config)),
      sensor_(makeSensor(world, info)),
      schedule_(info.config.rate, time_step),
      noise_(info.config.noise, blankOf(world, info)),
      delay_(info.config.delay, time_step, blankOf(world, info)) {}

bool SensorChannel::read(const StepContext& step, std::uint64_t number, SensorSample* out) {
  const bool due = schedule_.due(number);
  if (!due && delay_.steps() == 0) return false;
  sensor_->measure(step, &out->reading);
  tare_.apply(&out->reading);
  if (!has_truth_) return due && sensor_->measured(out->reading);
  out->truth = out->reading;
  if (!delay_.pass(&out->reading) || !due) return false;
  noise_.add(schedule_.period(), &sensor_->random(), &out->reading);
  sensor_->addNoise(&out->reading);
  limit(config_.limits, &out->reading);
  sensor_->settle(&out->reading);
  if (!sensor_->measured(*out->truth)) out->truth.reset();
  return sensor_->measured(out->reading);
}

void SensorChannel::remake(const SimulatedWorld& world, const SensorInfo& info, double time_step) {
  SensorChannel made(world, info, time_step);
  made.sensor_->random() = sensor_->random();
  made.noise_ = std::move(noise_);
  made.tare_ = tare_;
  if (made.delay_.steps() == delay_.steps()) made.delay_ = std::move(delay_);
  *this = std::move(made);
}

void SensorChannel::save(geometry::StateWriter* writer) const {
  writer->word(sensor_->random().state());
  noise_.save(writer);
  delay_.save(writer);
}

void SensorChannel::restore(geometry::StateReader* reader) {
  sensor_->random().setState(reader->word());
  noise_.restore(reader);
  delay_.restore(reader);
  tare_.reset();
}

void SensorChannel::reset() {
  noise_.reset();
  delay_.clear();
  tare_.reset();
}

}  // namespace blem_sim::sim
