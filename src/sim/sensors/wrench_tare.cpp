#include "sensors/wrench_tare.h"

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

void WrenchTare::append(std::vector<double>* numbers) const {
  numbers->push_back(asked_ ? 1 : 0);
  for (const Vector3* zero : {&force_, &torque_}) numbers->insert(numbers->end(), zero->data(), zero->data() + 3);
}

void WrenchTare::read(NumberReader* reader) {
  asked_ = reader->choice(2) == 1;
  for (Vector3* zero : {&force_, &torque_}) reader->numbers(zero->data(), 3);
}

}  // namespace blem_sim::sim
