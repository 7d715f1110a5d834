#include "sensors/sensor_set.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "numbers/content_hash.h"

namespace blem_sim::sim {

void SensorSet::make(const SimulatedWorld& world, double time_step, std::uint64_t random_seed) {
  for (std::size_t i = channels_.size(); i < world.sensors.size(); ++i) {
    channels_.emplace_back(world, world.sensors[i], time_step);
    seedOne(world, i, random_seed);
  }
  spare_.resize(channels_.size());
}

void SensorSet::removeOf(const SimulatedWorld& world, int robot) {
  for (std::size_t i = channels_.size(); i-- > 0;) {
    if (world.sensors[i].robot != robot) continue;
    channels_.erase(channels_.begin() + static_cast<std::ptrdiff_t>(i));
    spare_.erase(spare_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void SensorSet::remake(const SimulatedWorld& world, double time_step) {
  for (std::size_t i = 0; i < channels_.size(); ++i) channels_[i].remake(world, world.sensors[i], time_step);
}

void SensorSet::resetOf(const SimulatedWorld& world, int robot) {
  for (std::size_t i = 0; i < channels_.size(); ++i)
    if (world.sensors[i].robot == robot) channels_[i].reset();
}

void SensorSet::seed(const SimulatedWorld& world, std::uint64_t random_seed) {
  for (std::size_t i = 0; i < channels_.size(); ++i) seedOne(world, i, random_seed);
}

// A sensor's noise is a stream of its own, told by names: other sensors and robots change nothing in it.
void SensorSet::seedOne(const SimulatedWorld& world, std::size_t sensor, std::uint64_t random_seed) {
  const SensorInfo& info = world.sensors[sensor];
  ContentHash seed;
  seed.add(random_seed).add(world.robots[info.robot].name).add(info.config.name);
  channels_[sensor].random().setState(seed.value());
}

void SensorSet::takeBack(std::vector<SensorSample>* samples) {
  for (SensorSample& sample : *samples) spare_[sample.sensor] = std::move(sample);
  samples->clear();
}

void SensorSet::read(const StepContext& step, std::uint64_t number, std::vector<SensorSample>* samples) {
  const auto reads_contacts = [number](const SensorChannel& channel) { return channel.readsContacts(number); };
  if (std::any_of(channels_.begin(), channels_.end(), reads_contacts)) link_contacts_.index(step.world, step.contacts);
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (!channels_[i].read(step, number, &spare_[i])) continue;
    spare_[i].sensor = static_cast<int>(i);
    samples->push_back(std::move(spare_[i]));
  }
}

void SensorSet::save(geometry::StateWriter* writer) const {
  for (const SensorChannel& channel : channels_) channel.save(writer);
}

void SensorSet::restore(const SimulatedWorld& world, double time_step, geometry::StateReader* reader) {
  channels_.clear();
  for (const SensorInfo& sensor : world.sensors) {
    channels_.emplace_back(world, sensor, time_step);
    channels_.back().restore(reader);
  }
  spare_.resize(channels_.size());
}

bool SensorSet::isTared() const {
  return std::any_of(channels_.begin(), channels_.end(), [](const SensorChannel& channel) { return channel.tare().any(); });
}

void SensorSet::saveTares(geometry::StateWriter* writer) const {
  for (const SensorChannel& channel : channels_) channel.tare().save(writer);
}

void SensorSet::restoreTares(geometry::StateReader* reader) {
  for (SensorChannel& channel : channels_) channel.tare().restore(reader);
}

}  // namespace blem_sim::sim
