#include "blem_sim/geometry/input_error.h"
#include "sensors/types/sensor.h"

namespace blem_sim::sim {
namespace {

class MotorCurrentSensor : public Sensor {
 public:
  MotorCurrentSensor(const SimulatedWorld& world, const SensorInfo& info) : robot_(world.robots[info.robot]) {
    for (const std::string& joint : robot_.joint_names) {
      const model::Transmission* transmission = robot_.description->transmissionOf(joint);
      torque_constants_.push_back((transmission ? transmission->reduction : 1) * torqueConstant(info.config, joint));
    }
  }

  void measure(const StepContext& step, SensorReading* out) override {
    MotorCurrentReading& reading = readingIn<MotorCurrentReading>(out);
    reading.joints = robot_.joint_names;
    reading.efforts.clear();
    reading.currents.clear();
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      reading.efforts.push_back(step.joints[robot_.joints[i]].effort);
      reading.currents.push_back(reading.efforts.back() / torque_constants_[i]);
    }
  }

 private:
  static double torqueConstant(const SensorConfig& config, const std::string& joint) {
    for (const std::string& key : {joint, std::string("default")}) {
      const auto entry = config.torque_constant.find(key);
      if (entry == config.torque_constant.end()) continue;
      if (std::isfinite(entry->second) && entry->second != 0) return entry->second;
      throw InputError("sensors: " + config.name + ": torque_constant: " + key + ": needs a finite number of N m/A that is not 0");
    }
    return 1;
  }

  const RobotInfo robot_;
  std::vector<double> torque_constants_;  ///< [N m/A] seen at the joints
};

}  // namespace

std::unique_ptr<Sensor> makeMotorCurrentSensor(const SimulatedWorld& world, const SensorInfo& info) {
  return std::make_unique<MotorCurrentSensor>(world, info);
}

}  // namespace blem_sim::sim
