#include <cmath>

#include "sensors/types/sensor.h"

namespace blem_sim::sim {
namespace {

/** Closed while a link is pressed, from both sides too. */
class ContactSwitch : public Sensor {
 public:
  ContactSwitch(const SimulatedWorld& world, const SensorInfo& info)
      : threshold_(info.config.threshold),
        model_(world.robots[info.robot].model),
        link_(world.robots[info.robot].description->linkIndex(info.config.link)) {}

  void measure(const StepContext& step, SensorReading* out) override {
    ContactSwitchReading& reading = readingIn<ContactSwitchReading>(out);
    reading.force = 0;
    for (const LinkContacts::Entry& entry : step.link_contacts.of(model_, link_)) {
      const ContactReport& contact = step.contacts[entry.contact];
      reading.force += std::abs(contact.force.dot(contact.normal_BA));
    }
    settle(out);
  }

  void settle(SensorReading* out) const override {
    ContactSwitchReading& reading = std::get<ContactSwitchReading>(*out);
    reading.closed = reading.force > threshold_;
  }
  bool readsContacts() const override { return true; }

 private:
  const double threshold_;
  const int model_, link_;
};

}  // namespace

std::unique_ptr<Sensor> makeContactSwitch(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<ContactSwitch>(world, info);
}

}  // namespace blem_sim::sim
