#include "sensor.h"

namespace blem_sim {
namespace {

/** Contacts of one link, not of the links that are rigidly joined to it. */
class ContactSensor : public Sensor {
 public:
  ContactSensor(const SimulatedWorld& world, const SensorInfo& info)
      : robot_(world.robots[info.robot]), link_(robot_.description->linkIndex(info.config.link)) {}

  void read(const StepContext& step, double, SensorReading* out) override {
    ContactReading& reading = readingIn<ContactReading>(out);
    reading.contacts.clear();
    reading.total = Wrench();
    reading.link_body = robot_.bodies[robot_.lumped->link_placement[link_].body];
    // Contact points and forces belong to the start of the step.
    const Vector3 p_WL = step.world.linkPose(robot_, link_, step.bodies_before).translation();
    for (std::size_t i = 0; i < step.contacts.size(); ++i) {
      const ContactReport& contact = step.contacts[i];
      const bool on_a = isLink(step.world.colliders[contact.collider_a]), on_b = isLink(step.world.colliders[contact.collider_b]);
      if (!on_a && !on_b) continue;
      const Vector3 force = on_a ? contact.force : Vector3(-contact.force);
      reading.contacts.push_back(static_cast<int>(i));
      reading.total.force += force;
      reading.total.torque += (contact.point - p_WL).cross(force);
    }
  }

 private:
  bool isLink(const Collider& collider) const { return collider.model == robot_.model && collider.link == link_; }

  const RobotInfo robot_;
  const int link_;
};

}  // namespace

std::unique_ptr<Sensor> makeContactSensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<ContactSensor>(world, info);
}

}  // namespace blem_sim
