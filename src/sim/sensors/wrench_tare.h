// Zero of a force-torque sensor.
#pragma once

#include <vector>

#include "blem_sim/sim/step_report.h"
#include "numbers/number_reader.h"

namespace blem_sim::sim {

/** Once asked to, takes what is measured next for zero. Other sensors are left as they are. */
class WrenchTare {
 public:
  void ask() { asked_ = true; }
  void reset() { *this = WrenchTare(); }

  void apply(SensorReading* reading);
  /** True once it was asked for. */
  bool any() const { return asked_ || !force_.isZero(0) || !torque_.isZero(0); }

  void append(std::vector<double>* numbers) const;
  void read(NumberReader* reader);

 private:
  Vector3 force_ = Vector3::Zero(), torque_ = Vector3::Zero();  // that are told as zero, sensor axes
  bool asked_ = false;
};

}  // namespace blem_sim::sim
