// Zero of a force-torque sensor.
#pragma once

#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/sim/step_report.h"

namespace blem_sim::sim {

/** Once asked to, takes what is measured next for zero. Other sensors are left as they are. */
class WrenchTare {
 public:
  void ask() { asked_ = true; }
  void reset() { *this = WrenchTare(); }

  void apply(SensorReading* reading);
  /** Whether readings are told otherwise than measured, or will be. */
  bool any() const { return asked_ || !force_.isZero(0) || !torque_.isZero(0); }

  void save(geometry::StateWriter* writer) const;
  void restore(geometry::StateReader* reader);

 private:
  Vector3 force_ = Vector3::Zero(), torque_ = Vector3::Zero();  // that are told as zero, sensor axes
  bool asked_ = false;
};

}  // namespace blem_sim::sim
