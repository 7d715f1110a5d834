#include "sensors/types/sensor.h"

namespace blem_sim::sim {
namespace {

/** Contacts of one link, not of the links that are rigidly joined to it. */
class ContactSensor : public Sensor {
 public:
  ContactSensor(const SimulatedWorld& world, const SensorInfo& info)
      : robot_(world.robots[info.robot]), link_(robot_.description->linkIndex(info.config.link)) {}

  void measure(const StepContext& step, SensorReading* out) override {
    ContactReading& reading = readingIn<ContactReading>(out);
    reading.contacts.clear();
    reading.wrenches.clear();
    reading.total = Wrench();
    reading.link_body = robot_.bodies[robot_.lumped->link_placement[link_].body];
    // Contact points and forces belong to the start of the step.
    const Vector3 p_WL = step.world.linkPose(robot_, link_, step.bodies_before).translation();
    for (const LinkContacts::Entry& entry : step.link_contacts.of(robot_.model, link_)) {
      const Wrench wrench = wrenchOfContact(step.contacts[entry.contact], entry.on_a, p_WL);
      reading.contacts.push_back(entry.contact);
      reading.wrenches.push_back(wrench);
      reading.total.force += wrench.force;
      reading.total.torque += wrench.torque;
    }
  }
  bool readsContacts() const override { return true; }

 private:
  const RobotInfo robot_;
  const int link_;
};

}  // namespace

std::unique_ptr<Sensor> makeContactSensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<ContactSensor>(world, info);
}

}  // namespace blem_sim::sim
