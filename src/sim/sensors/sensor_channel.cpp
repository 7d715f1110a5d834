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

/** Orientation of a tilt's angles as they are read, with the heading that it has. */
void turnToAngles(const Vector3& x_W, TiltReading* reading) {
  const double yaw = std::atan2(x_W.y(), x_W.x());
  reading->orientation = Eigen::AngleAxisd(yaw, Vector3::UnitZ()) * Eigen::AngleAxisd(reading->pitch, Vector3::UnitY()) *
                         Eigen::AngleAxisd(reading->roll, Vector3::UnitX());
}

void limit(const SensorLimits& limits, SensorReading* reading) {
  forEachNumber(reading, [&](double& number, int quantity) {
    if (quantity >= 0) number = limited(number, limits[static_cast<std::size_t>(quantity)]);
  });
  auto* const tilt = std::get_if<TiltReading>(reading);
  if (tilt && limits[0].any()) turnToAngles(tilt->orientation * Vector3::UnitX(), tilt);
}

}  // namespace

SensorChannel::SensorChannel(const SimulatedWorld& world, const SensorInfo& info, double time_step)
    : config_(info.config),
      has_truth_(hasGroundTruth(info.config)),
      sensor_(makeSensor(world, info)),
      schedule_(info.config.rate, time_step),
      delay_(info.config.delay, time_step, blankReading(info.config.type, world.robots[info.robot].joint_names)) {}

bool SensorChannel::read(const StepContext& step, std::uint64_t number, SensorSample* out) {
  const bool due = schedule_.due(number);
  if (!due && delay_.steps() == 0) return false;
  sensor_->measure(step, &out->reading);
  if (!has_truth_) return due;
  out->truth = out->reading;
  if (!delay_.pass(&out->reading) || !due) return false;
  sensor_->addNoise(schedule_.period(), &out->reading);
  limit(config_.limits, &out->reading);
  return true;
}

void SensorChannel::remake(const SimulatedWorld& world, const SensorInfo& info, double time_step) {
  SensorChannel made(world, info, time_step);
  geometry::StateContent memory;
  geometry::StateWriter writer(&memory);
  sensor_->save(&writer);
  geometry::StateReader reader(memory);
  made.sensor_->restore(&reader);
  made.sensor_->random() = sensor_->random();
  if (made.delay_.steps() == delay_.steps()) made.delay_ = std::move(delay_);
  *this = std::move(made);
}

void SensorChannel::save(geometry::StateWriter* writer) const {
  writer->word(sensor_->random().state());
  sensor_->save(writer);
  delay_.save(writer);
}

void SensorChannel::restore(geometry::StateReader* reader) {
  sensor_->random().setState(reader->word());
  sensor_->restore(reader);
  delay_.restore(reader);
}

void SensorChannel::reset() {
  sensor_->reset();
  delay_.clear();
}

}  // namespace blem_sim::sim
