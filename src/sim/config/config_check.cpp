#include "config/config_check.h"

#include <fmt/format.h>

#include <cmath>

#include "blem_sim/geometry/far_origin.h"
#include "blem_sim/geometry/input_error.h"
#include "config/range_sensor_check.h"
#include "config/scene_limits.h"
#include "config/yaml_reader.h"

namespace blem_sim::sim {
namespace {

/** Checks fields of one part of the configuration. */
class Fields {
 public:
  explicit Fields(std::string where) : where_(std::move(where)) {}

  void number(const char* field, double value, const NumberRange& range) const {
    const bool within = value <= range.upper && (range.open ? value > range.lower : value >= range.lower);
    if (!within) throw InputError(fmt::format("{}{}: is {}; give it {}", where_, field, value, range.words));
  }
  void number(const char* field, const std::optional<double>& value, const NumberRange& range) const {
    if (value) number(field, *value, range);
  }
  void atLeastOne(const char* field, int value) const {
    if (value < 1) throw InputError(fmt::format("{}{}: is {}; give it a whole number of at least 1", where_, field, value));
  }
  void finite(const char* field, bool is_finite) const {
    if (!is_finite) throw InputError(fmt::format("{}{}: is not finite; give it finite numbers", where_, field));
  }
  void pose(const char* field, const Pose& X) const {
    finite(field, X.matrix().allFinite());
    if ((X.translation().array().abs() > geometry::FARTHEST_PLACE).any())
      throw InputError(
          fmt::format("{}{}: lies beyond {:g} m; give it metres from a place near the robot", where_, field, geometry::FARTHEST_PLACE));
    if (!X.linear().isUnitary(1e-6) || X.linear().determinant() < 0)
      throw InputError(fmt::format("{}{}: is no rotation; give it orthogonal unit axes, right-handed", where_, field));
  }
  void width(const BoundaryWidth& width) const {
    number("boundary_width", width.metres, {0, WIDEST_LAYER, false, "metres from 0 to 1000"});
  }
  void scale(const Vector3& scale) const {
    if (!scale.allFinite() || (scale.array() == 0).any())
      throw InputError(fmt::format("{}scale: needs three finite numbers other than 0", where_));
  }
  void surface(const contact::SurfaceProperties& s) const {
    number("friction", s.friction, NumberRange::notNegative());
    number("restitution", s.restitution, NumberRange::fraction());
    number("impact_friction_factor", s.impact_friction_factor, NumberRange::fraction());
    number("impact_friction_speed", s.impact_friction_speed, NumberRange::notNegative());
    number("stiffness", s.stiffness, NumberRange::positiveOrInfinite());
    number("damping", s.damping, NumberRange::notNegativeOrInfinite());
  }
  void rays(const SensorConfig& sensor) const {
    if (const auto fault = faultOf(sensor.type, sensor.rays)) throw InputError(where_ + fault->key + ": " + fault->why);
  }
  void overrides(const ContactOverrides& o) const {
    if (o.boundary_width) width(*o.boundary_width);
    number("friction", o.friction, NumberRange::notNegative());
    number("restitution", o.restitution, NumberRange::fraction());
    number("impact_friction_factor", o.impact_friction_factor, NumberRange::fraction());
    number("impact_friction_speed", o.impact_friction_speed, NumberRange::notNegative());
    number("stiffness", o.stiffness, NumberRange::positiveOrInfinite());
    number("damping", o.damping, NumberRange::notNegativeOrInfinite());
  }

 private:
  const std::string where_;
};

void checkSolver(const dynamics::SolverSettings& solver) {
  const Fields fields("solver.");
  if (solver.threads) fields.atLeastOne("threads", *solver.threads);
  fields.atLeastOne("quick_step_iterations", solver.quick_step_iterations);
  fields.number("cfm", solver.cfm, NumberRange::notNegative());
  fields.number("correction_fraction", solver.correction_fraction, NumberRange::fraction());
  fields.number("max_correction_speed", solver.max_correction_speed, NumberRange::notNegative());
  fields.number("joint_erp", solver.joint_erp, NumberRange::fraction());
  fields.number("joint_cfm", solver.joint_cfm, NumberRange::notNegative());
}

void checkContact(const ContactConfig& contact) {
  const Fields fields("contact.");
  fields.width(contact.boundary_width);
  fields.surface(contact.surface);
  fields.atLeastOne("max_contacts_per_robot", contact.max_contacts_per_robot);
  fields.atLeastOne("max_contacts_per_object", contact.max_contacts_per_object);
}

void checkArmature(const RobotConfig& robot, const dynamics::SolverSettings& solver) {
  if (solver.stepper == "articulated") return;
  for (const auto& [joint, inertia] : robot.armature)
    if (inertia > 0)
      throw InputError(
          fmt::format("robots: {}: armature: {}: {} knows no rotor inertia; set solver.stepper to articulated, or leave it out", robot.name,
                      joint, solver.stepper));
}

void checkObject(const ObjectConfig& object) {
  const Fields fields("objects: " + object.name + ": ");
  fields.pose("pose", object.X_WO);
  fields.pose("mesh_pose", object.X_OM);
  fields.scale(object.scale);
  fields.number("mass", object.mass, NumberRange::positive());
  if (object.com) fields.finite("com", object.com->allFinite());
  if (object.inertia) fields.finite("inertia", object.inertia->allFinite());
  fields.overrides(object.contact);
  if (object.max_contacts) fields.atLeastOne("max_contacts", *object.max_contacts);
}

}  // namespace

void checkRobot(const RobotConfig& robot) {
  const Fields fields("robots: " + robot.name + ": ");
  fields.pose("pose", robot.X_WR);
  fields.pose("odom.pose", robot.odom.X_WF);
  fields.overrides(robot.contact);
  if (robot.max_contacts) fields.atLeastOne("max_contacts", *robot.max_contacts);
  for (const auto& [link, contact] : robot.links) Fields("robots: " + robot.name + ": links." + link + ": ").overrides(contact);
  for (const SensorConfig& sensor : robot.sensors) {
    const Fields of_sensor("robots: " + robot.name + ": sensors: " + sensor.name + ": ");
    of_sensor.pose("pose", sensor.X_LS);
    of_sensor.pose("offset", sensor.X_offset);
    if (sensor.rate != RATE_OFF) of_sensor.number("rate", sensor.rate, NumberRange::notNegative());
    for (const QuantityNoise& noise : sensor.noise) {
      of_sensor.number("noise", noise.bias, NumberRange::any());
      for (const double deviation : {noise.stddev, noise.bias_stddev, noise.bias_spread})
        of_sensor.number("noise", deviation, NumberRange::notNegative());
    }
    of_sensor.number("threshold", sensor.threshold, NumberRange::notNegative());
    of_sensor.rays(sensor);
  }
}

void checkEnvironment(const EnvironmentConfig& environment) {
  const Fields fields("environments: " + environment.name + ": ");
  fields.pose("pose", environment.X_WE);
  fields.scale(environment.scale);
  fields.overrides(environment.contact);
}

void checkConfig(const SimulationConfig& config) {
  if (!(config.time_step > 0) || !std::isfinite(config.time_step))
    throw InputError("time_step: needs a finite number of seconds above 0, such as 0.001");
  const std::size_t models = config.environments.size() + config.robots.size() + config.objects.size();
  if (models > MOST_MODELS)
    throw InputError(fmt::format("objects: {} environments, robots and objects are more than the {} that are simulated; give fewer", models,
                                 MOST_MODELS));
  if (!(config.gravity.array().abs() <= LARGEST_GRAVITY).all())
    throw InputError(fmt::format("gravity: needs three numbers, not beyond {:g} m/s^2, such as [0, 0, -9.81]", LARGEST_GRAVITY));
  checkSolver(config.solver);
  checkContact(config.contact);
  for (const EnvironmentConfig& environment : config.environments) checkEnvironment(environment);
  for (const RobotConfig& robot : config.robots) {
    checkRobot(robot);
    checkArmature(robot, config.solver);
  }
  for (const ObjectConfig& object : config.objects) checkObject(object);
}

}  // namespace blem_sim::sim
