#include "sensors/types/sensor.h"

namespace blem_sim::sim {
namespace {

/** Ground truth of a frame on a link, with noise if told to. */
class OdometrySensor : public Sensor {
 public:
  OdometrySensor(const SimulatedWorld& world, const SensorInfo& info)
      : config_(info.config), frame_(world, world.robots[info.robot], info.config.link, info.config.X_LS) {}

  void measure(const StepContext& step, SensorReading* out) override {
    const MountedFrame::Motion motion = frame_.motion(step.bodies);
    const Matrix3 R_AW = config_.twist == "world" ? Matrix3(Matrix3::Identity()) : Matrix3(motion.X_WS.linear().transpose());
    OdometryReading& reading = readingIn<OdometryReading>(out);
    reading.position = motion.X_WS.translation() + config_.X_offset.translation();
    reading.orientation = Quaternion(config_.X_offset.linear() * motion.X_WS.linear()).normalized();
    reading.linear_velocity = R_AW * motion.v_WS;
    reading.angular_velocity = R_AW * motion.w_WS;
    reading.stddev = 0;
  }

  void addNoise(SensorReading* out) override {
    if (config_.noise[0].stddev > 0) disturb(config_.noise[0].stddev, &std::get<OdometryReading>(*out));
  }

 private:
  void disturb(double stddev, OdometryReading* reading) {
    reading->stddev = stddev;
    reading->position += stddev * random_.gaussianVector();
    const Vector3 turn = stddev * random_.gaussianVector();
    reading->orientation = (Quaternion(Eigen::AngleAxisd(turn.norm(), turn.stableNormalized())) * reading->orientation).normalized();
    reading->linear_velocity += stddev * random_.gaussianVector();
    reading->angular_velocity += stddev * random_.gaussianVector();
  }

  const SensorConfig config_;
  const MountedFrame frame_;
};

}  // namespace

std::unique_ptr<Sensor> makeOdometrySensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<OdometrySensor>(world, info);
}

}  // namespace blem_sim::sim
