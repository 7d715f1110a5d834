// Sensors, which turn an accepted step into readings. A new one is one class here, one row in makeSensor, one alternative in SensorReading.
#pragma once

#include <memory>
#include <vector>

#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/sim/step_report.h"
#include "build/simulated_world.h"
#include "numbers/random_numbers.h"
#include "sensors/types/link_contacts.h"

namespace blem_sim::sim {

/** Input of sensors: one accepted step. */
struct StepContext {
  const SimulatedWorld& world;
  double dt;                                              ///< [s] of the step
  const std::vector<dynamics::BodyState>& bodies_before;  ///< at the start of the step
  const std::vector<dynamics::BodyState>& bodies;         ///< at its end
  const std::vector<dynamics::JointState>& joints;        ///< at its end
  const std::vector<Wrench>& joint_wrenches;              ///< mean over the step, as SolveResult has them
  const std::vector<ContactReport>& contacts;
  const LinkContacts& link_contacts;  ///< of these contacts, if a sensor that is read has readsContacts()
};

class Sensor {
 public:
  virtual ~Sensor() = default;
  /** The truth. @param out overwritten; if it holds a reading of this sensor already, its memory is used again */
  virtual void measure(const StepContext& step, SensorReading* out) = 0;
  /** Noise upon a reading of measure(), of this step or an earlier one, beside that of ReadingNoise. */
  virtual void addNoise(SensorReading* reading) {}
  /** Lets what follows from a reading's numbers follow from them as they are read, noise and limits included. */
  virtual void settle(SensorReading* reading) const {}
  /** False: there was nothing to measure, so there is no reading. */
  virtual bool measured(const SensorReading& reading) const { return true; }
  virtual bool readsContacts() const { return false; }

  RandomNumbers& random() { return random_; }
  const RandomNumbers& random() const { return random_; }

 protected:
  RandomNumbers random_;
};

/** The alternative that a sensor fills; its old content stays in it. */
template <typename Reading>
Reading& readingIn(SensorReading* out) {
  return std::holds_alternative<Reading>(*out) ? std::get<Reading>(*out) : out->emplace<Reading>();
}

std::unique_ptr<Sensor> makeForceTorqueSensor(const SimulatedWorld& world, const SensorInfo& info);
std::unique_ptr<Sensor> makeImuSensor(const SimulatedWorld& world, const SensorInfo& info);
std::unique_ptr<Sensor> makeContactSensor(const SimulatedWorld& world, const SensorInfo& info);
std::unique_ptr<Sensor> makeContactSwitch(const SimulatedWorld& world, const SensorInfo& info);
std::unique_ptr<Sensor> makeCentreOfPressureSensor(const SimulatedWorld& world, const SensorInfo& info);
std::unique_ptr<Sensor> makeTiltSensor(const SimulatedWorld& world, const SensorInfo& info);
std::unique_ptr<Sensor> makeMotorCurrentSensor(const SimulatedWorld& world, const SensorInfo& info);
std::unique_ptr<Sensor> makeOdometrySensor(const SimulatedWorld& world, const SensorInfo& info);
std::unique_ptr<Sensor> makeRangeSensor(const SimulatedWorld& world, const SensorInfo& info);
std::unique_ptr<Sensor> makeSensor(const SimulatedWorld& world, const SensorInfo& info);

/** A frame that is fixed on a link, and its motion. */
class MountedFrame {
 public:
  /** @param X_LS frame in the link */
  MountedFrame(const SimulatedWorld& world, const RobotInfo& robot, const std::string& link, const Pose& X_LS);

  struct Motion {
    Pose X_WS = Pose::Identity();
    Vector3 v_WS = Vector3::Zero(), w_WS = Vector3::Zero();  ///< of the origin and of the axes, world axes
  };
  Motion motion(const std::vector<dynamics::BodyState>& bodies) const;

 private:
  int body_;
  Pose X_BS_;  ///< in the world's frame if the body is the world
  Vector3 p_BCom_ = Vector3::Zero();
};

}  // namespace blem_sim::sim
