#include "scene/joint_readings.h"

#include <cmath>

namespace blem_sim::dynamics {
namespace {

// Angle of a hinge since it was assembled. The same as ODE's, which takes longer to compute.
double hingeAngle(const Scene& scene, const JointSlot& slot) {
  const auto turnOf = [&](int body) { return quaternionFromOde(dBodyGetQuaternion(scene.bodies()[body].ode)); };
  Quaternion turn = turnOf(slot.spec.child);
  if (slot.spec.parent != WORLD_BODY) turn = turnOf(slot.spec.parent).conjugate() * turn;
  turn = turn * slot.assembled_turn.conjugate();
  return 2 * std::atan2(slot.parent_axis.dot(turn.vec()), turn.w());
}

}  // namespace

Vector3 jointAxis(const Scene& scene, int joint) {
  const JointSlot& slot = scene.joints()[joint];
  dVector3 axis;
  if (slot.spec.kind == JointKind::REVOLUTE)
    dJointGetHingeAxis(slot.joint, axis);
  else
    dJointGetSliderAxis(slot.joint, axis);
  return fromOde(axis);
}

Vector3 jointOrigin(const Scene& scene, int joint, const std::vector<BodyBits>& bits) {
  const JointSpec& spec = scene.joints()[joint].spec;
  const Vector3& p_PJ = spec.X_PJ.translation();
  if (spec.parent == WORLD_BODY) return p_PJ;
  const BodyBits& parent = bits[spec.parent];
  return parent.com() + parent.rotation() * (p_PJ - scene.bodies()[spec.parent].spec.inertial.com);
}

double jointPosition(const Scene& scene, int joint) {
  const JointSlot& slot = scene.joints()[joint];
  if (!slot.joint || slot.spec.kind == JointKind::FIXED) return 0;
  if (slot.spec.kind == JointKind::PRISMATIC) return slot.assembled_position + dJointGetSliderPosition(slot.joint);
  const double one_turn = slot.assembled_position + hingeAngle(scene, slot);
  return one_turn + 2 * M_PI * std::round((slot.last_position - one_turn) / (2 * M_PI));
}

double jointVelocity(const Scene& scene, int joint) {
  const JointSlot& slot = scene.joints()[joint];
  if (!slot.joint || slot.spec.kind == JointKind::FIXED) return 0;
  const int child = slot.spec.child, parent = slot.spec.parent;
  const bool grounded = parent == WORLD_BODY;
  Vector3 axis = slot.parent_axis, parent_spin = Vector3::Zero();
  if (!grounded) {
    axis = scene.rotation(parent) * axis;
    parent_spin = scene.spin(parent);
  }
  if (slot.spec.kind == JointKind::REVOLUTE) return axis.dot(scene.spin(child) - parent_spin);
  if (grounded) return axis.dot(scene.velocity(child));
  return axis.dot(scene.velocity(child) - scene.velocity(parent) - parent_spin.cross(scene.com(child) - scene.com(parent)));
}

Matrix3 inertiaInWorld(const Scene& scene, int body, const Matrix3& R_WB) {
  return R_WB * scene.bodies()[body].spec.inertial.inertia * R_WB.transpose();
}

double inverseInertia(const Scene& scene, int joint) {
  const JointSlot& slot = scene.joints()[joint];
  const Vector3 axis = jointAxis(scene, joint);
  double sum = 0;
  for (const int body : {slot.spec.child, slot.spec.parent}) {
    if (body == WORLD_BODY) continue;
    sum += slot.spec.kind == JointKind::PRISMATIC ? 1 / scene.bodies()[body].spec.inertial.mass
                                                  : axis.dot(inertiaInWorld(scene, body, scene.rotation(body)).inverse() * axis);
  }
  return sum;
}

// A rotor may make more than half a turn in a step: the full turns are those nearest to where its velocity leads.
void readJoints(double dt, Scene* scene, std::vector<JointState>* states) {
  states->resize(scene->joints().size());
  for (std::size_t j = 0; j < scene->joints().size(); ++j) {
    const int joint = static_cast<int>(j);
    JointSlot& slot = scene->joints()[j];
    const double velocity = jointVelocity(*scene, joint);
    slot.last_position += dt * velocity;
    (*states)[j] = {jointPosition(*scene, joint), velocity, slot.last_effort};
    if (slot.joint) slot.last_position = (*states)[j].position;
  }
}

}  // namespace blem_sim::dynamics
