#include "blem_sim/sim/sensor_values.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "blem_sim/sim/range_view.h"

namespace blem_sim::sim {

namespace {

class Row {
 public:
  Row& add(const std::string& name, double value) {
    row_.names.push_back(name);
    row_.values.push_back(value);
    return *this;
  }
  Row& add(const std::string& name, const Vector3& v) { return add(name + "_x", v.x()).add(name + "_y", v.y()).add(name + "_z", v.z()); }
  Row& add(const Quaternion& q) {
    return add("orientation_x", q.x()).add("orientation_y", q.y()).add("orientation_z", q.z()).add("orientation_w", q.w());
  }
  operator SensorValues() const { return row_; }

 private:
  SensorValues row_;
};

struct ToRow {
  SensorValues operator()(const ForceTorqueReading& r) const { return Row().add("force", r.force).add("torque", r.torque); }
  SensorValues operator()(const ImuReading& r) const {
    return Row().add("linear_acceleration", r.linear_acceleration).add("angular_velocity", r.angular_velocity).add(r.orientation);
  }
  SensorValues operator()(const ContactReading& r) const {
    return Row().add("force", r.total.force).add("torque", r.total.torque).add("contacts", static_cast<double>(r.contacts.size()));
  }
  SensorValues operator()(const TiltReading& r) const {
    return Row().add("roll", r.roll).add("pitch", r.pitch).add("angular_velocity", r.angular_velocity).add(r.orientation);
  }
  SensorValues operator()(const MotorCurrentReading& r) const {
    Row row;
    for (std::size_t i = 0; i < r.joints.size(); ++i) row.add(r.joints[i] + "_current", r.currents[i]);
    for (std::size_t i = 0; i < r.joints.size(); ++i) row.add(r.joints[i] + "_effort", r.efforts[i]);
    return row;
  }
  SensorValues operator()(const OdometryReading& r) const {
    Row row;
    row.add("position", r.position).add(r.orientation);
    return row.add("linear_velocity", r.linear_velocity).add("angular_velocity", r.angular_velocity);
  }
  SensorValues operator()(const ContactSwitchReading& r) const { return Row().add("force", r.force).add("closed", r.closed ? 1 : 0); }
  SensorValues operator()(const CentreOfPressureReading& r) const { return Row().add("x", r.x).add("y", r.y).add("force", r.force); }
  SensorValues operator()(const DepthCameraReading& r) const { return summary(r.view ? depthsOf(*r.view) : std::vector<float>()); }
  SensorValues operator()(const LidarReading& r) const { return summary(r.view ? rangesOf(*r.view) : std::vector<float>()); }

  /** Nearest, farthest and mean range [m] of the rays that hit, 0 if none does, and their share of all. */
  static SensorValues summary(const std::vector<float>& ranges) {
    double nearest = 0, farthest = 0, sum = 0, hits = 0;
    for (const double range : ranges) {
      if (!std::isfinite(range)) continue;
      nearest = hits > 0 ? std::min(nearest, range) : range;
      farthest = std::max(farthest, range);
      sum += range;
      ++hits;
    }
    Row row;
    row.add("nearest", nearest).add("farthest", farthest).add("mean", hits > 0 ? sum / hits : 0);
    return row.add("hits", ranges.empty() ? 0 : hits / static_cast<double>(ranges.size()));
  }
};

}  // namespace

SensorValues sensorValues(const SensorReading& reading) { return std::visit(ToRow(), reading); }

SensorReading blankReading(SensorType type, const std::vector<std::string>& joints) {
  const std::vector<double> none(joints.size());
  const Vector3 zero = Vector3::Zero();
  switch (type) {
    case SensorType::FORCE_TORQUE:
      return ForceTorqueReading{zero, zero, ""};
    case SensorType::IMU:
      return ImuReading{Quaternion::Identity(), zero, zero, 0, 0};
    case SensorType::CONTACT:
      return ContactReading();
    case SensorType::CONTACT_SWITCH:
      return ContactSwitchReading();
    case SensorType::CENTRE_OF_PRESSURE:
      return CentreOfPressureReading();
    case SensorType::TILT:
      return TiltReading{Quaternion::Identity(), zero, 0, 0};
    case SensorType::MOTOR_CURRENT:
      return MotorCurrentReading{joints, none, none};
    case SensorType::ODOMETRY:
      return OdometryReading{zero, Quaternion::Identity(), zero, zero, 0};
    case SensorType::DEPTH_CAMERA:
      return DepthCameraReading();
    case SensorType::LIDAR:
      break;
  }
  return LidarReading();
}

bool hasGroundTruth(const SensorConfig& sensor) {
  const bool noisy_rays = isRangeSensor(sensor.type) && (sensor.rays.stddev > 0 || sensor.rays.noise != RangeNoise::GAUSSIAN);
  const auto any = [](const auto& of) { return of[0].any() || of[1].any(); };
  return noisy_rays || sensor.delay > 0 || any(sensor.noise) || any(sensor.limits);
}

std::vector<std::string> sensorFields(const Simulator& simulator, const SensorInfo& sensor) {
  const auto& joints = simulator.robots()[static_cast<std::size_t>(sensor.robot)].joint_names;
  return sensorValues(blankReading(sensor.config.type, joints)).names;
}

std::vector<std::string> sensorNames(const Simulator& simulator) {
  std::map<std::string, int> uses;
  for (const SensorInfo& sensor : simulator.sensors()) ++uses[sensor.config.name];
  std::vector<std::string> names;
  for (const SensorInfo& sensor : simulator.sensors()) {
    const std::string& name = sensor.config.name;
    names.push_back(uses[name] > 1 ? simulator.robots()[static_cast<std::size_t>(sensor.robot)].name + "::" + name : name);
  }
  return names;
}

}  // namespace blem_sim::sim
