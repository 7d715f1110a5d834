#include "sensors/types/sensor.h"

namespace blem_sim::sim {
namespace {

/** Specific force and angular velocity of a frame on a link. The acceleration is the step's change of velocity over dt, lever arm included.
 */
class ImuSensor : public Sensor {
 public:
  ImuSensor(const SimulatedWorld& world, const SensorInfo& info)
      : config_(info.config), frame_(world, world.robots[info.robot], info.config.link, info.config.X_LS) {}

  void measure(const StepContext& step, SensorReading* out) override {
    const MountedFrame::Motion before = frame_.motion(step.bodies_before), after = frame_.motion(step.bodies);
    const Vector3 specific_force = (after.v_WS - before.v_WS) / step.dt - step.world.world.gravity();
    // A difference of velocities belongs to the middle of the step, and so do the axes it is seen in.
    const Quaternion end(after.X_WS.linear());
    const Quaternion middle = Quaternion(before.X_WS.linear()).slerp(0.5, end);
    ImuReading& reading = readingIn<ImuReading>(out);
    reading.orientation = end.normalized();
    reading.angular_velocity = end.conjugate() * after.w_WS;
    reading.linear_acceleration = middle.conjugate() * specific_force;
    reading.accel_stddev = reading.gyro_stddev = 0;
  }

  void addNoise(SensorReading* out) override {
    ImuReading& reading = std::get<ImuReading>(*out);
    reading.accel_stddev = config_.noise[0].stddev;
    reading.gyro_stddev = config_.noise[1].stddev;
  }

 private:
  const SensorConfig config_;
  const MountedFrame frame_;
};

}  // namespace

std::unique_ptr<Sensor> makeImuSensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<ImuSensor>(world, info);
}

}  // namespace blem_sim::sim
