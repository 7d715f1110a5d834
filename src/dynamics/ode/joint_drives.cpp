#include "ode/joint_drives.h"

#include <algorithm>
#include <cmath>

#include "lanes/spatial.h"
#include "scene/joint_readings.h"

namespace blem_sim::dynamics {
namespace {

enum MotorRow { PD_ROW, VISCOUS_ROW, DRY_ROW };

/** v+ = velocity - cfm * effort, |effort| <= bound. */
struct Row {
  double velocity = 0, cfm = 0, bound = 0;
};

// Reach of a limit: rows are added once a joint could be there soon, so that it never lands in a step without its row.
constexpr double LIMIT_REACH = 0.02;   // [rad or m], on top of two steps of motion
constexpr double LOCKED_RANGE = 1e-9;  // [rad or m] between limits that hold the joint
// Dry friction against a rigid bilateral row needs some softness; relative to the speed one newton (metre) gives in one step to all that
// the joint carries. (Of its two bodies alone one may be a massless link of a wrist.)
constexpr double DRY_SOFTNESS = 1e-9;

void setParameter(const JointSlot& slot, int parameter, double value) {
  if (slot.spec.kind == JointKind::REVOLUTE)
    dJointSetAMotorParam(slot.motor, parameter, value);
  else
    dJointSetLMotorParam(slot.motor, parameter, value);
}

void setRow(const JointSlot& slot, MotorRow which, const Row& row) {
  const int group = which * dParamGroup;
  setParameter(slot, dParamVel + group, row.velocity);
  setParameter(slot, dParamCFM + group, row.cfm);
  setParameter(slot, dParamFMax + group, std::isinf(row.bound) ? dInfinity : row.bound);
}

/** Position and velocity of a joint. */
struct JointMotion {
  double q = 0, velocity = 0;
};

Row pdRow(const JointDrive& drive, const JointMotion& motion, double dt, double softness) {
  const double gain = dt * drive.stiffness + drive.damping;
  if (!(gain > 0) || !(drive.max_effort > 0)) return {};
  const double wanted = (drive.stiffness * (drive.target_position - motion.q) + drive.damping * drive.target_velocity) / gain;
  const Row law{wanted, 1 / gain, drive.max_effort};
  if (wanted >= drive.min_velocity && wanted <= drive.max_velocity) return law;
  // A law that leads beyond a velocity becomes one that leads to it, with the effort of now: one row has no third piece.
  const bool upwards = wanted > drive.max_velocity;
  const double end = upwards ? drive.max_velocity : drive.min_velocity;
  const bool is_faster = upwards ? motion.velocity > end : motion.velocity < end;
  const double effort = is_faster ? drive.max_effort : gain * std::abs(wanted - motion.velocity);
  return {end, std::max(softness, 1 / drive.velocity_gain), std::min(drive.max_effort, effort)};
}

/** Inertia along its axis of all that a joint carries, for each joint in a tree; 0 for others. */
std::vector<double> carriedInertias(const Scene& scene) {
  std::vector<BodyBits> bits;
  scene.bits(&bits);
  std::vector<SpatialInertia> carried(bits.size());
  for (std::size_t b = 0; b < bits.size(); ++b)
    if (scene.exists(static_cast<int>(b))) carried[b] = SpatialInertia(scene.bodies()[b].spec.inertial, bits[b].rotation(), bits[b].com());
  std::vector<double> inertias(scene.joints().size(), 0);
  for (const int joint : scene.leavesFirst()) {
    const JointSlot& slot = scene.joints()[joint];
    if (slot.spec.kind != JointKind::FIXED) {
      const Vector3 axis = jointAxis(scene, joint);
      const bool turns = slot.spec.kind == JointKind::REVOLUTE;
      const Vector6 twist = turns ? spatial(axis, jointOrigin(scene, joint, bits).cross(axis)) : spatial(Vector3::Zero(), axis);
      inertias[joint] = twist.dot(carried[slot.spec.child].times(twist));
    }
    if (slot.spec.parent != WORLD_BODY) carried[slot.spec.parent].add(carried[slot.spec.child]);
  }
  return inertias;
}

/** @param softness of a row that is to be rigid */
void setMotorRows(const JointSlot& slot, const JointDrive& drive, const JointMotion& motion, double dt, double softness) {
  Row pd = pdRow(drive, motion, dt, softness);
  Row viscous;
  if (drive.viscous_friction > 0) viscous = {0, 1 / drive.viscous_friction, dInfinity};
  // Two unbounded linear rows are one: fewer rows, better conditioned.
  if (viscous.bound > 0 && std::isinf(pd.bound)) {
    const double gain = 1 / pd.cfm + drive.viscous_friction;
    pd = {pd.velocity / (pd.cfm * gain), 1 / gain, dInfinity};
    viscous = {};
  }
  Row dry;
  if (drive.dry_friction > 0) dry = {0, softness, drive.dry_friction};
  setRow(slot, PD_ROW, pd);
  setRow(slot, VISCOUS_ROW, viscous);
  setRow(slot, DRY_ROW, dry);
}

void setStopParameter(const JointSlot& slot, int parameter, double value) {
  if (slot.spec.kind == JointKind::REVOLUTE)
    dJointSetHingeParam(slot.joint, parameter, value);
  else
    dJointSetSliderParam(slot.joint, parameter, value);
}

// A hinge keeps an old stop alive if both stops are out of its range, so the upper one stays in it; no angle reaches pi.
void clearStop(const JointSlot& slot) {
  setStopParameter(slot, dParamLoStop, -dInfinity);
  setStopParameter(slot, dParamHiStop, slot.spec.kind == JointKind::REVOLUTE ? M_PI : dInfinity);
}

double returnSpeed(double gap, double dt, const SolverSettings& settings) {
  return gap > 0 ? -gap / dt : std::min(-settings.joint_erp * gap / dt, settings.max_correction_speed);
}

// ODE's stop is a row v+ >= -stop_erp/dt * error; the error is held at -1 (lower) or 1 (upper) and the speed put into stop_erp.
void setStop(const JointSlot& slot, const JointMotion& motion, double dt, const SolverSettings& settings, double cfm) {
  clearStop(slot);
  const auto& [q, velocity] = motion;
  const JointSpec& spec = slot.spec;
  const double below = q - spec.lower, above = spec.upper - q;
  const double reach = LIMIT_REACH + 2 * dt * std::abs(velocity);
  if (below > reach && above > reach) return;
  const double ode_q = spec.kind == JointKind::REVOLUTE ? dJointGetHingeAngle(slot.joint) : dJointGetSliderPosition(slot.joint);
  setStopParameter(slot, dParamStopCFM, cfm);
  if (spec.upper - spec.lower < LOCKED_RANGE) {
    setStopParameter(slot, dParamLoStop, ode_q - below);
    setStopParameter(slot, dParamHiStop, ode_q - below);
    setStopParameter(slot, dParamStopERP, settings.joint_erp);
  } else if (below + dt * velocity < above - dt * velocity) {
    setStopParameter(slot, dParamHiStop, dInfinity);
    setStopParameter(slot, dParamLoStop, ode_q + 1);
    setStopParameter(slot, dParamStopERP, dt * returnSpeed(below, dt, settings));
  } else {
    setStopParameter(slot, dParamHiStop, ode_q - 1);
    setStopParameter(slot, dParamStopERP, dt * returnSpeed(above, dt, settings));
  }
}

void addEffort(const JointSlot& slot, double effort) {
  if (slot.spec.kind == JointKind::REVOLUTE)
    dJointAddHingeTorque(slot.joint, effort);
  else
    dJointAddSliderForce(slot.joint, effort);
}

/** Effort of the implicit PD out of that of all rows: its law at the step's end, as far as friction explains the rest. */
double ofMotor(double of_rows, const JointDrive& drive, const JointMotion& end) {
  if (!(drive.stiffness + drive.damping > 0)) return 0;
  const double law = drive.stiffness * (drive.target_position - end.q) + drive.damping * (drive.target_velocity - end.velocity);
  const double without_viscous = of_rows + drive.viscous_friction * end.velocity;
  return std::clamp(std::clamp(law, -drive.max_effort, drive.max_effort), without_viscous - drive.dry_friction,
                    without_viscous + drive.dry_friction);
}

}  // namespace

void setDrives(Scene* scene, const StepInput& input, const std::vector<double>& coupling, const SolverSettings& settings,
               double cfm_scale) {
  const double dt = input.dt;
  const double cfm = settings.joint_cfm * cfm_scale;
  const std::vector<double> inertias = carriedInertias(*scene);
  for (std::size_t j = 0; j < scene->joints().size(); ++j) {
    const JointSlot& slot = scene->joints()[j];
    if (!slot.motor) continue;
    const int joint = static_cast<int>(j);
    const double inverse_inertia = inertias[j] > 0 ? 1 / inertias[j] : inverseInertia(*scene, joint);
    const JointMotion motion{jointPosition(*scene, joint), jointVelocity(*scene, joint)};
    setMotorRows(slot, input.drives[j], motion, dt, std::max(cfm, DRY_SOFTNESS * dt * (inverse_inertia * cfm_scale)));
    setStop(slot, motion, dt, settings, cfm);
    addEffort(slot, input.drives[j].givenEffort() + coupling[j]);
  }
}

void readEfforts(const Scene& scene, const std::vector<JointDrive>& drives, const std::vector<double>& coupling,
                 const std::vector<Vector3>& axes, SolveResult* result) {
  result->motor_efforts.assign(scene.joints().size(), 0);
  result->axis_efforts.assign(scene.joints().size(), 0);
  for (std::size_t j = 0; j < scene.joints().size(); ++j) {
    const JointSlot& slot = scene.joints()[j];
    if (!slot.motor) continue;
    const dJointFeedback& f = slot.motor_feedback;
    const Vector3 on_child = slot.spec.kind == JointKind::REVOLUTE ? fromOde(f.t1) : fromOde(f.f1);
    const double of_rows = axes[j].dot(on_child);
    result->axis_efforts[j] = drives[j].givenEffort() + coupling[j] + of_rows;
    const int joint = static_cast<int>(j);
    result->motor_efforts[j] = drives[j].effort + ofMotor(of_rows, drives[j], {jointPosition(scene, joint), jointVelocity(scene, joint)});
  }
}

}  // namespace blem_sim::dynamics
