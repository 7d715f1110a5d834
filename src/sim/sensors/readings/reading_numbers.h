// Numbers of a reading, one by one: to be kept while they are on their way, or held to a sensor's range and resolution.
#pragma once

#include <variant>

#include "blem_sim/sim/step_report.h"

namespace blem_sim::sim {

/** Calls use(number, quantity) for each, always in the same order; quantity: index into SensorConfig::limits, -1: none. */
template <typename Use>
class ReadingNumbers {
 public:
  explicit ReadingNumbers(Use use) : use_(std::move(use)) {}

  void operator()(ForceTorqueReading& r) {
    vector(&r.force, 0);
    vector(&r.torque, 1);
  }
  void operator()(ImuReading& r) {
    vector(&r.linear_acceleration, 0);
    vector(&r.angular_velocity, 1);
    vector(&r.orientation.coeffs(), -1);
  }
  void operator()(TiltReading& r) {
    use_(r.roll, 0);
    use_(r.pitch, 0);
    vector(&r.angular_velocity, 1);
    vector(&r.orientation.coeffs(), -1);
  }
  void operator()(MotorCurrentReading& r) {
    for (double& current : r.currents) use_(current, 0);
    for (double& effort : r.efforts) use_(effort, 1);
  }
  void operator()(ContactSwitchReading& r) { use_(r.force, 0); }
  void operator()(CentreOfPressureReading& r) {
    use_(r.x, 0);
    use_(r.y, 0);
    use_(r.force, -1);
  }
  // Contacts belong to their step, and pictures are drawn elsewhere.
  void operator()(ContactReading&) {}
  void operator()(OdometryReading&) {}
  void operator()(DepthCameraReading&) {}
  void operator()(LidarReading&) {}

 private:
  template <typename Vector>
  void vector(Vector* v, int quantity) {
    for (int i = 0; i < v->size(); ++i) use_((*v)[i], quantity);
  }

  Use use_;
};

template <typename Use>
void forEachNumber(SensorReading* reading, Use use) {
  std::visit(ReadingNumbers<Use>(std::move(use)), *reading);
}

}  // namespace blem_sim::sim
