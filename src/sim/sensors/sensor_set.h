// All sensors of a world.
#pragma once

#include <cstdint>
#include <vector>

#include "sensors/sensor_channel.h"
#include "sensors/types/link_contacts.h"

namespace blem_sim::sim {

/** Sensors in the order of SimulatedWorld::sensors. */
class SensorSet {
 public:
  /** Makes sensors that the world has got since, with noise of their own. @param time_step [s] */
  void make(const SimulatedWorld& world, double time_step, std::uint64_t random_seed);
  /** Takes out the sensors of a robot that the world still has. */
  void removeOf(const SimulatedWorld& world, int robot);
  /** Makes all sensors again, as their bodies are now. */
  void remake(const SimulatedWorld& world, double time_step);
  /** Forgets what a robot's sensors remember and what is on its way. */
  void resetOf(const SimulatedWorld& world, int robot);
  /** Lets the noise of all sensors begin anew. */
  void seed(const SimulatedWorld& world, std::uint64_t random_seed);

  /** Takes back samples that are not needed any more, whose memory the next readings use. */
  void takeBack(std::vector<SensorSample>* samples);
  /** Adds the readings whose time has come. @param step with linkContacts() @param number of the step, from 1 */
  void read(const StepContext& step, std::uint64_t number, std::vector<SensorSample>* samples);
  /** Contacts by link of the step that is read, if a sensor asks for them. */
  const LinkContacts& linkContacts() const { return link_contacts_; }
  WrenchTare& tare(int sensor) { return channels_[static_cast<std::size_t>(sensor)].tare(); }

  /** Saves all but zeros of force-torque sensors. */
  void save(geometry::StateWriter* writer) const;
  /** Makes the sensors of a world from a state. */
  void restore(const SimulatedWorld& world, double time_step, geometry::StateReader* reader);
  /** Whether a sensor has a zero of its own, or will have. */
  bool isTared() const;
  void saveTares(geometry::StateWriter* writer) const;
  void restoreTares(geometry::StateReader* reader);

 private:
  void seedOne(const SimulatedWorld& world, std::size_t sensor, std::uint64_t random_seed);

  std::vector<SensorChannel> channels_;
  std::vector<SensorSample> spare_;  // by sensor
  LinkContacts link_contacts_;
};

}  // namespace blem_sim::sim
