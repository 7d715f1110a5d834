#include <algorithm>
#include <cmath>

#include "sensors/sensor.h"

namespace blem_sim::sim {
namespace {

class TiltSensor : public Sensor {
 public:
  TiltSensor(const SimulatedWorld& world, const SensorInfo& info)
      : frame_(world, world.robots[info.robot], info.config.link, info.config.X_LS) {}

  void measure(const StepContext& step, SensorReading* out) override {
    const MountedFrame::Motion motion = frame_.motion(step.bodies);
    const Matrix3 R = motion.X_WS.linear();
    TiltReading& reading = readingIn<TiltReading>(out);
    reading.orientation = Quaternion(R).normalized();
    reading.angular_velocity = R.transpose() * motion.w_WS;
    // Angles of Rz(yaw) Ry(pitch) Rx(roll).
    reading.roll = std::atan2(R(2, 1), R(2, 2));
    reading.pitch = std::asin(std::max(-1.0, std::min(1.0, -R(2, 0))));
  }

 private:
  const MountedFrame frame_;
};

}  // namespace

std::unique_ptr<Sensor> makeTiltSensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<TiltSensor>(world, info);
}

}  // namespace blem_sim::sim
