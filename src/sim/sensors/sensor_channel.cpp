#include "sensors/sensor_channel.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "blem_sim/sim/sensor_values.h"
#include "sensors/reading_numbers.h"

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

void SensorChannel::Memory::reset() {
  noise.reset();
  delay.clear();
  tare.reset();
}

void SensorChannel::Memory::append(std::vector<double>* numbers) const {
  noise.append(numbers);
  delay.append(numbers);
}

void SensorChannel::Memory::read(NumberReader* reader) {
  noise.read(reader);
  delay.read(reader);
}

SensorChannel::SensorChannel(const SimulatedWorld& world, const SensorInfo& info, double time_step)
    : config_(info.config),
      has_truth_(hasGroundTruth(info.config)),
      sensor_(makeSensor(world, info)),
      schedule_(info.config.rate, time_step),
      memory_{{info.config.noise, blankOf(world, info)}, {info.config.delay, time_step, blankOf(world, info)}, {}} {}

bool SensorChannel::read(const StepContext& step, std::uint64_t number, SensorSample* out) {
  const bool due = schedule_.due(number);
  if (!due && memory_.delay.steps() == 0) return false;
  sensor_->measure(step, &out->reading);
  memory_.tare.apply(&out->reading);
  if (!has_truth_) return due && sensor_->measured(out->reading);
  out->truth = out->reading;
  if (!memory_.delay.pass(&out->reading) || !due) return false;
  memory_.noise.add(schedule_.period(), &sensor_->random(), &out->reading);
  sensor_->addNoise(&out->reading);
  limit(config_.limits, &out->reading);
  sensor_->settle(&out->reading);
  if (!sensor_->measured(*out->truth)) out->truth.reset();
  return sensor_->measured(out->reading);
}

void SensorChannel::remake(const SimulatedWorld& world, const SensorInfo& info, double time_step) {
  SensorChannel made(world, info, time_step);
  made.sensor_->random() = sensor_->random();
  made.memory_.noise = std::move(memory_.noise);
  made.memory_.tare = memory_.tare;
  if (made.memory_.delay.steps() == memory_.delay.steps()) made.memory_.delay = std::move(memory_.delay);
  *this = std::move(made);
}

}  // namespace blem_sim::sim
