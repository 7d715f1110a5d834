#include "sensors/types/sensor.h"

namespace blem_sim::sim {

MountedFrame::MountedFrame(const SimulatedWorld& world, const RobotInfo& robot, const std::string& link, const Pose& X_LS) {
  const model::LinkPlacement& placement = robot.lumped->link_placement[robot.description->linkIndex(link)];
  body_ = robot.bodies[placement.body];
  X_BS_ = placement.X_BL * X_LS;
  if (body_ == dynamics::WORLD_BODY)
    X_BS_ = robot.X_WR * X_BS_;
  else
    p_BCom_ = world.world.bodySpec(body_).inertial.com;
}

MountedFrame::Motion MountedFrame::motion(const std::vector<dynamics::BodyState>& bodies) const {
  if (body_ == dynamics::WORLD_BODY) return {X_BS_, Vector3::Zero(), Vector3::Zero()};
  const dynamics::BodyState& state = bodies[body_];
  Motion motion;
  motion.X_WS = state.X_WB * X_BS_;
  motion.w_WS = state.w_WB;
  motion.v_WS = state.v_WCom + state.w_WB.cross(motion.X_WS.translation() - state.X_WB * p_BCom_);
  return motion;
}

std::unique_ptr<Sensor> makeSensor(const SimulatedWorld& world, const SensorInfo& info) {
  switch (info.config.type) {
    case SensorType::FORCE_TORQUE:
      return makeForceTorqueSensor(world, info);
    case SensorType::IMU:
      return makeImuSensor(world, info);
    case SensorType::CONTACT:
      return makeContactSensor(world, info);
    case SensorType::CONTACT_SWITCH:
      return makeContactSwitch(world, info);
    case SensorType::CENTRE_OF_PRESSURE:
      return makeCentreOfPressureSensor(world, info);
    case SensorType::TILT:
      return makeTiltSensor(world, info);
    case SensorType::MOTOR_CURRENT:
      return makeMotorCurrentSensor(world, info);
    case SensorType::ODOMETRY:
      return makeOdometrySensor(world, info);
    case SensorType::DEPTH_CAMERA:
    case SensorType::LIDAR:
      return makeRangeSensor(world, info);
  }
  return nullptr;
}

}  // namespace blem_sim::sim
