#include "sensors/readings/wrench_tare.h"

namespace blem_sim::sim {

void WrenchTare::apply(SensorReading* reading) {
  auto* const wrench = std::get_if<ForceTorqueReading>(reading);
  if (!wrench) return;
  if (asked_) {
    force_ = wrench->force;
    torque_ = wrench->torque;
    asked_ = false;
  }
  wrench->force -= force_;
  wrench->torque -= torque_;
}

void WrenchTare::save(geometry::StateWriter* writer) const {
  writer->number(asked_ ? 1 : 0);
  for (const Vector3* zero : {&force_, &torque_}) writer->vector(*zero);
}

void WrenchTare::restore(geometry::StateReader* reader) {
  asked_ = reader->choice(2) == 1;
  for (Vector3* zero : {&force_, &torque_}) *zero = reader->vector();
}

}  // namespace blem_sim::sim
