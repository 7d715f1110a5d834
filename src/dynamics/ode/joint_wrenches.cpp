#include "ode/joint_wrenches.h"

#include <Eigen/LU>

#include "scene/joint_readings.h"

namespace blem_sim::dynamics {
namespace {

// The torque ODE adds to every body: implicit in the angular velocity, so that it does not gain energy.
Vector3 gyroscopicTorque(const Matrix3& I, const Vector3& w, double dt) {
  const Vector3 L = I * w;
  Matrix3 cross;
  cross << 0, -L.z(), L.y(), L.z(), 0, -L.x(), -L.y(), L.x(), 0;
  const Matrix3 implicit = I - dt * cross;
  Matrix3 inverse;
  bool invertible = false;
  implicit.computeInverseWithCheck(inverse, invertible, 0);
  if (!invertible) return Vector3::Zero();
  return (I * inverse - Matrix3::Identity()) * L / dt;
}

/** Moves a wrench about `from` to one about `to`. */
Wrench moved(const Wrench& w, const Vector3& from, const Vector3& to) { return {w.force, w.torque + (from - to).cross(w.force)}; }

void addWrench(const Wrench& w, double sign, Wrench* to) {
  to->force += sign * w.force;
  to->torque += sign * w.torque;
}

// Wrench that a body needs to move as it did, less gravity and outside wrenches; about its com.
Wrench needed(const Scene& scene, int body, const BodyBits& start, double dt) {
  const BodySlot& slot = scene.bodies()[body];
  const BodyBits end = scene.bits(body);
  const Matrix3 I = inertiaInWorld(scene, body, start.rotation());
  Wrench w;
  w.force = slot.spec.inertial.mass * ((end.velocity() - start.velocity()) / dt - scene.gravity()) - slot.pending.force;
  w.torque = I * (end.spin() - start.spin()) / dt - gyroscopicTorque(I, start.spin(), dt) - slot.pending.torque;
  return w;
}

Wrench feedbackOnChild(const JointSlot& slot, int joint, const Scene& scene, double given_effort) {
  Wrench w{fromOde(slot.joint_feedback.f1), fromOde(slot.joint_feedback.t1)};
  if (!slot.motor) return w;
  w.force += fromOde(slot.motor_feedback.f1);
  w.torque += fromOde(slot.motor_feedback.t1);
  const Vector3 axis = jointAxis(scene, joint);
  (slot.spec.kind == JointKind::REVOLUTE ? w.torque : w.force) += given_effort * axis;
  return w;
}

}  // namespace

void jointWrenches(const Scene& scene, const std::vector<BodyBits>& start, const StepInput& input, const SolveResult& result,
                   std::vector<Wrench>* wrenches) {
  // Wrench each body needs from its own joint, about its com at the start.
  std::vector<Wrench> open(start.size());
  for (std::size_t b = 0; b < start.size(); ++b)
    if (scene.exists(static_cast<int>(b))) open[b] = needed(scene, static_cast<int>(b), start[b], input.dt);
  for (std::size_t i = 0; i < input.contacts.size(); ++i) {
    const ContactConstraint& c = input.contacts[i];
    const Wrench on_a{result.contact_forces[i], Vector3::Zero()};
    if (scene.exists(c.body_a)) addWrench(moved(on_a, c.point, start[c.body_a].com()), -1, &open[c.body_a]);
    if (scene.exists(c.body_b)) addWrench(moved(on_a, c.point, start[c.body_b].com()), 1, &open[c.body_b]);
  }
  wrenches->assign(scene.joints().size(), Wrench());
  const auto settle = [&](int joint, const Wrench& on_child) {
    const JointSpec& spec = scene.joints()[joint].spec;
    const Vector3 child = start[spec.child].com();
    (*wrenches)[joint] = moved(on_child, child, jointOrigin(scene, joint, start));
    if (spec.parent != WORLD_BODY) addWrench(moved(on_child, child, start[spec.parent].com()), 1, &open[spec.parent]);
  };
  for (std::size_t j = 0; j < scene.joints().size(); ++j) {
    const JointSlot& slot = scene.joints()[j];
    if (!slot.joint || slot.in_tree) continue;
    const Wrench on_child = feedbackOnChild(slot, static_cast<int>(j), scene, input.drives[j].givenEffort());
    addWrench(on_child, -1, &open[slot.spec.child]);
    settle(static_cast<int>(j), on_child);
  }
  for (const int joint : scene.leavesFirst()) settle(joint, open[scene.joints()[joint].spec.child]);
}

}  // namespace blem_sim::dynamics
