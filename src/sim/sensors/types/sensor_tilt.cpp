#include <algorithm>
#include <cmath>

#include "sensors/types/sensor.h"

namespace blem_sim::sim {
namespace {

class TiltSensor : public Sensor {
 public:
  TiltSensor(const SimulatedWorld& world, const SensorInfo& info)
      : config_(info.config), frame_(world, world.robots[info.robot], info.config.link, info.config.X_LS) {}

  void measure(const StepContext& step, SensorReading* out) override {
    const MountedFrame::Motion motion = frame_.motion(step.bodies);
    const Matrix3 R = motion.X_WS.linear();
    TiltReading& reading = readingIn<TiltReading>(out);
    reading.orientation = Quaternion(R).normalized();
    reading.angular_velocity = R.transpose() * motion.w_WS;
    // Angles of Rz(yaw) Ry(pitch) Rx(roll).
    reading.roll = std::atan2(R(2, 1), R(2, 2));
    reading.pitch = std::asin(std::max(-1.0, std::min(1.0, -R(2, 0))));
    reading.angle_stddev = reading.gyro_stddev = 0;
  }

  void addNoise(SensorReading* out) override {
    TiltReading& reading = std::get<TiltReading>(*out);
    reading.angle_stddev = config_.noise[0].stddev;
    reading.gyro_stddev = config_.noise[1].stddev;
  }

  // The orientation is that of the angles as they are read, at the heading that it has.
  void settle(SensorReading* out) const override {
    if (!config_.noise[0].any() && !config_.limits[0].any()) return;
    TiltReading& reading = std::get<TiltReading>(*out);
    const Vector3 x_W = reading.orientation * Vector3::UnitX();
    const double yaw = std::atan2(x_W.y(), x_W.x());
    reading.orientation = Eigen::AngleAxisd(yaw, Vector3::UnitZ()) * Eigen::AngleAxisd(reading.pitch, Vector3::UnitY()) *
                          Eigen::AngleAxisd(reading.roll, Vector3::UnitX());
  }

 private:
  const SensorConfig config_;
  const MountedFrame frame_;
};

}  // namespace

std::unique_ptr<Sensor> makeTiltSensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<TiltSensor>(world, info);
}

}  // namespace blem_sim::sim
