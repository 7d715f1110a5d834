#include "build/robot_motors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "blem_sim/geometry/input_error.h"
#include "build/by_joint.h"
#include "wheels/wheel_measures.h"

namespace blem_sim::sim {
namespace {

constexpr std::size_t LISTED_JOINTS = 12;  // in a note
constexpr double VELOCITY_TIME = 1;        // [s] in which a joint that keeps a velocity lags by as much as gravity sags one that holds

JointFriction frictionOf(const RobotConfig& config, const model::LumpedJoint& joint) {
  return byJoint(config.joint_friction, joint.name, JointFriction{joint.dry_friction, joint.viscous_friction});
}

/** Writes the motors of one robot, joint by joint. */
class MotorWriter {
 public:
  MotorWriter(const RobotConfig& config, const model::RobotModel& model, RobotMotors* motors)
      : config_(config), model_(model), motors_(*motors) {}

  /** @param moved load of the motor: the joint's own, and those of joints that follow it */
  void add(const model::LumpedJoint& joint, const JointLoad& load, const JointLoad& moved) {
    MotorSettings settings;
    settings.commanded = joint.moves() && !joint.mimic;
    settings.continuous = joint.type == model::JointType::CONTINUOUS;
    if (joint.moves()) {
      settings.friction = frictionOf(config_, joint);
      settings.effort_limit = byJoint(config_.effort_limits, joint.name, joint.limits.effort);
      settings.law = byJoint(config_.motor, joint.name, MotorLaw::IMPLICIT_PD);
      settings.velocity_limit = velocityLimit(joint);
      settings.safety = joint.safety;
      settings.inertia = lightInertia(load);
      settings.command_timeout = config_.command_timeout;
    }
    if (settings.commanded) addGains(joint, moved, &settings);
    if (settings.commanded && settings.gains.p + settings.gains.d > 0) addWeakness(joint.name, settings.effort_limit, moved.friction);
    motors_.settings.push_back(settings);
  }

  void addNotes() {
    if (!unlimited_.empty())
      motors_.notes.push_back(fmt::format("velocity limits of 0 are taken as none: {}; set velocity_limits", listed(unlimited_)));
    if (!not_explicit_.empty())
      motors_.notes.push_back(fmt::format("motor: pid needs gains, implicit_pd holds: {}; give gains", listed(not_explicit_)));
    if (!free_.empty())
      motors_.notes.push_back(fmt::format("joints without gains move freely: {}; give gains, or motors: computed", listed(free_)));
    if (!computed_.empty())
      motors_.notes.push_back(fmt::format(
          "computed gains hold the pose of joints without gains, p [N m/rad or N/m] and d [N m s/rad or N s/m]: {}; give gains for others",
          listed(computed_)));
  }

 private:
  const JointGains* givenGains(const std::string& joint) const {
    const auto pid_gains = config_.pid_gains.find(joint);
    if (const JointGains* gains = entryOf(config_.gains, joint)) return gains;
    return pid_gains == config_.pid_gains.end() ? nullptr : &pid_gains->second;
  }

  bool isFree(const std::string& joint) const {
    if (config_.motors == MotorDefault::TRANSMISSIONS) return !model_.transmissionOf(joint);
    return config_.motors == MotorDefault::FREE;
  }

  /** Parts of joints in drives. */
  enum class Role { NONE, WHEEL, CARRIED_WHEEL, STEERING };

  Role roleIn(const ControllerConfig& controller, const std::string& joint) const {
    const auto isIn = [&](const std::vector<std::string>& joints) {
      return std::find(joints.begin(), joints.end(), joint) != joints.end();
    };
    const SteeringConfig& steering = controller.drive.steering;
    if (controller.kind == ControllerKind::DRIVE) return isIn(controller.joints) ? Role::WHEEL : Role::NONE;
    if (controller.kind != ControllerKind::STEERED_DRIVE) return Role::NONE;
    if (isIn(steering.joints)) return Role::STEERING;
    if (isIn(steering.driven)) return Role::WHEEL;
    return isIn(steering.rear) || steeringAbove(model_.jointIndex(joint), steering, model_) >= 0 ? Role::CARRIED_WHEEL : Role::NONE;
  }

  Role roleOf(const std::string& joint) const {
    std::vector<ControllerConfig> controllers = config_.controllers.value_or(std::vector<ControllerConfig>());
    controllers.insert(controllers.end(), config_.drives.begin(), config_.drives.end());
    for (const ControllerConfig& controller : controllers)
      if (const Role role = roleIn(controller, joint); role != Role::NONE) return role;
    return Role::NONE;
  }

  double velocityLimit(const model::LumpedJoint& joint) {
    const double limit = byJoint(config_.velocity_limits, joint.name, joint.limits.velocity);
    if (limit > 0) return limit;
    unlimited_.push_back(joint.name);
    return std::numeric_limits<double>::infinity();
  }

  /** Wheels of drives need no gains: those with a motor keep velocities whatever they are, the others roll freely. */
  void addGains(const model::LumpedJoint& joint, const JointLoad& load, MotorSettings* settings) {
    const Role role = roleOf(joint.name);
    const bool is_wheel = role == Role::WHEEL || role == Role::CARRIED_WHEEL;
    if (const JointGains* given = givenGains(joint.name)) {
      settings->gains = *given;
    } else if (role == Role::CARRIED_WHEEL || (isFree(joint.name) && role != Role::STEERING)) {
      if (!is_wheel) free_.push_back(joint.name);
    } else {
      if (settings->law == MotorLaw::PID) not_explicit_.push_back(joint.name);
      settings->law = MotorLaw::IMPLICIT_PD;
      settings->gains = computedGains(load, joint, settings->effort_limit);
      settings->velocity_gain = VELOCITY_TIME * settings->gains.p;
      if (!is_wheel) computed_.push_back(fmt::format("{} {:.3g} {:.3g}", joint.name, settings->gains.p, settings->gains.d));
    }
  }

  void addWeakness(const std::string& joint, double limit, double friction) {
    if (limit == 0)
      motors_.notes.push_back(fmt::format("joint '{}' has an effort limit of 0, so its motor does nothing; set effort_limits", joint));
    else if (friction >= limit)
      motors_.notes.push_back(
          fmt::format("joint '{}' has dry friction of {:.4g}, and its motor gives {:.4g} at most, so it does not move it; set "
                      "joint_friction or effort_limits",
                      joint, friction, limit));
  }

  static std::string listed(const std::vector<std::string>& items) {
    const std::size_t count = std::min(items.size(), LISTED_JOINTS);
    const std::string words = fmt::format("{}", fmt::join(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(count), ", "));
    return count == items.size() ? words : fmt::format("{} and {} more", words, items.size() - count);
  }

  const RobotConfig& config_;
  const model::RobotModel& model_;
  RobotMotors& motors_;
  std::vector<std::string> free_, computed_, not_explicit_, unlimited_;
};

}  // namespace

void checkMotors(const RobotConfig& config) {
  const auto refuse = [&](const std::string& what, const std::string& joint) {
    throw InputError(fmt::format("robots: {}: {}: {}: numbers must be finite and not negative", config.name, what, joint));
  };
  const auto wrong = [](double x) { return !(x >= 0) || std::isinf(x); };
  for (const auto& [field, by_joint] : {std::make_pair("gains", &config.gains), std::make_pair("pid_gains", &config.pid_gains)})
    for (const auto& [joint, gains] : *by_joint)
      if (wrong(gains.p) || wrong(gains.i) || wrong(gains.d) || !(gains.i_clamp >= 0)) refuse(field, joint);
  for (const auto& [joint, friction] : config.joint_friction)
    if (wrong(friction.dry) || wrong(friction.viscous)) refuse("joint_friction", joint);
  for (const auto& [joint, limit] : config.effort_limits)
    if (!(limit >= 0)) refuse("effort_limits", joint);
  for (const auto& [joint, limit] : config.velocity_limits)
    if (!(limit > 0)) throw InputError(fmt::format("robots: {}: velocity_limits: {}: must be above 0", config.name, joint));
  if (wrong(config.command_timeout))
    throw InputError(fmt::format("robots: {}: command_timeout: must be finite and not negative", config.name));
  for (const auto& [joint, inertia] : config.armature)
    if (wrong(inertia)) refuse("armature", joint);
  for (const auto& [joint, position] : config.initial_positions)
    if (!std::isfinite(position)) refuse("initial_positions", joint);
}

RobotMotors robotMotors(const RobotConfig& config, const model::RobotModel& model, const model::LumpedRobot& robot,
                        const std::vector<double>& positions, double gravity) {
  std::vector<JointLoad> loads = jointLoads(robot, positions, config.fixed_base, gravity);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const model::LumpedJoint& joint = robot.joints[j];
    if (!joint.moves()) continue;
    loads[j].child.inertia += byJoint(config.armature, joint.name, 0.0);
    loads[j].friction = frictionOf(config, joint).dry;
  }
  std::vector<JointLoad> moved = loads;
  addFollowers(robot, &moved);
  RobotMotors motors;
  MotorWriter writer(config, model, &motors);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) writer.add(robot.joints[j], loads[j], moved[j]);
  writer.addNotes();
  return motors;
}

}  // namespace blem_sim::sim
