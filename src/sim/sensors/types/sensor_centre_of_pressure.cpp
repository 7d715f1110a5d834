#include "sensors/types/sensor.h"

namespace blem_sim::sim {
namespace {

/** Point of a sole's plane about which the contacts' forces on its link have no moment along the plane. */
class CentreOfPressureSensor : public Sensor {
 public:
  CentreOfPressureSensor(const SimulatedWorld& world, const SensorInfo& info)
      : config_(info.config), robot_(world.robots[info.robot]), link_(robot_.description->linkIndex(info.config.link)) {}

  void measure(const StepContext& step, SensorReading* out) override {
    // Contact points and forces belong to the start of the step.
    const Pose X_WL = step.world.linkPose(robot_, link_, step.bodies_before), X_WS = X_WL * config_.X_LS;
    Wrench total;
    for (const LinkContacts::Entry& entry : step.link_contacts.of(robot_.model, link_)) {
      const Wrench wrench = wrenchOfContact(step.contacts[entry.contact], entry.on_a, X_WS.translation());
      total.force += wrench.force;
      total.torque += wrench.torque;
    }
    const Vector3 force = X_WS.linear().transpose() * total.force, torque = X_WS.linear().transpose() * total.torque;
    CentreOfPressureReading& reading = readingIn<CentreOfPressureReading>(out);
    reading = {};
    reading.force = force.z();
    if (!measured(*out)) return;
    reading.x = -torque.y() / force.z();
    reading.y = torque.x() / force.z();
  }

  bool measured(const SensorReading& reading) const override {
    return std::get<CentreOfPressureReading>(reading).force > config_.threshold;
  }
  bool readsContacts() const override { return true; }

 private:
  const SensorConfig config_;
  const RobotInfo robot_;
  const int link_;
};

}  // namespace

std::unique_ptr<Sensor> makeCentreOfPressureSensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<CentreOfPressureSensor>(world, info);
}

}  // namespace blem_sim::sim
