#include "sensors/sensor.h"

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

  void addNoise(double period, SensorReading* out) override {
    ImuReading& reading = std::get<ImuReading>(*out);
    reading.accel_stddev = config_.accel_stddev;
    reading.gyro_stddev = config_.gyro_stddev;
    drawBiases();
    disturb(config_.accel_stddev, config_.accel_bias_stddev, period, &accel_bias_, &reading.linear_acceleration);
    disturb(config_.gyro_stddev, config_.gyro_bias_stddev, period, &gyro_bias_, &reading.angular_velocity);
  }

  void reset() override {
    accel_bias_ = gyro_bias_ = Vector3::Zero();
    drawn_ = false;
  }
  void save(geometry::StateWriter* writer) const override {
    for (const Vector3* bias : {&accel_bias_, &gyro_bias_}) writer->vector(*bias);
    if (hasConstantBias()) writer->number(drawn_ ? 1 : 0);
  }
  void restore(geometry::StateReader* reader) override {
    for (Vector3* bias : {&accel_bias_, &gyro_bias_}) *bias = reader->vector();
    if (hasConstantBias()) drawn_ = reader->choice(2) == 1;
  }

 private:
  bool hasConstantBias() const {
    return config_.accel_bias != 0 || config_.gyro_bias != 0 || config_.accel_bias_spread > 0 || config_.gyro_bias_spread > 0;
  }

  /** Draws the constant biases, which those that walk start from. */
  void drawBiases() {
    if (!hasConstantBias() || drawn_) return;
    drawn_ = true;
    const auto draw = [&](double mean, double spread) {
      Vector3 bias = Vector3::Constant(mean);
      if (spread > 0) bias += spread * random_.gaussianVector();
      return bias;
    };
    accel_bias_ += draw(config_.accel_bias, config_.accel_bias_spread);
    gyro_bias_ += draw(config_.gyro_bias, config_.gyro_bias_spread);
  }

  /** Adds white noise, and a bias that walks: bias_stddev is its standard deviation after one second. */
  void disturb(double stddev, double bias_stddev, double period, Vector3* bias, Vector3* value) {
    if (bias_stddev > 0) *bias += bias_stddev * std::sqrt(period) * random_.gaussianVector();
    if (stddev > 0) *value += stddev * random_.gaussianVector();
    *value += *bias;
  }

  const SensorConfig config_;
  const MountedFrame frame_;
  Vector3 accel_bias_ = Vector3::Zero(), gyro_bias_ = Vector3::Zero();
  bool drawn_ = false;  // the constant biases
};

}  // namespace

std::unique_ptr<Sensor> makeImuSensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<ImuSensor>(world, info);
}

}  // namespace blem_sim::sim
