// Joints of the scene. ODE's first body is the child, so its angles, positions and motor efforts are the child's against the parent.
#include "blem_sim/geometry/free_slots.h"
#include "blem_sim/geometry/input_error.h"
#include "scene/input_check.h"
#include "scene/scene.h"

namespace blem_sim::dynamics {
namespace {

constexpr int MOTOR_ROWS = 3;  // implicit PD, viscous friction, dry friction

void checkJoint(const JointSpec& spec, const Scene& scene) {
  const std::string where = "joint '" + spec.name + "': ";
  if (!scene.exists(spec.child)) throw InputError(where + "child body does not exist; add it first");
  if (spec.parent != WORLD_BODY && !scene.exists(spec.parent)) throw InputError(where + "parent body does not exist; add it first");
  if (spec.parent == spec.child) throw InputError(where + "parent and child are the same body; correct one of them");
  if (!spec.axis.allFinite() || !(spec.axis.norm() > 0)) throw InputError(where + "axis has no direction; give it a unit vector");
  if (spec.lower > spec.upper) throw InputError(where + "lower limit is above the upper one; exchange them");
  const bool has_master =
      spec.mimic_joint < static_cast<int>(scene.joints().size()) && (spec.mimic_joint < 0 || scene.joints()[spec.mimic_joint].joint);
  if (!has_master) throw InputError(where + "mimic joint does not exist; add it first");
}

}  // namespace

int Scene::addJoint(const JointSpec& spec, double position) {
  checkJoint(spec, *this);
  checkJointNumbers(spec, position);
  const bool is_new = free_joints_.empty();
  const int joint = geometry::takeSlot(&free_joints_, &joints_);
  JointSlot& slot = joints_[joint];
  slot = JointSlot();
  slot.occupant = ++joints_added_;
  slot.spec = spec;
  slot.spec.axis.normalize();
  slot.child_assembled = bits(spec.child);
  if (spec.parent != WORLD_BODY) slot.parent_assembled = bits(spec.parent);
  slot.assembled_position = slot.last_position = position;
  slot.assembled_turn = slot.child_assembled.turn();
  if (spec.parent != WORLD_BODY) slot.assembled_turn = slot.parent_assembled.turn().conjugate() * slot.assembled_turn;
  slot.parent_axis = spec.X_PJ.linear() * slot.spec.axis;
  createJoint(&slot);
  // The order of slots decides which joint closes a loop, whatever the order they came in.
  if (is_new)
    placeInTree(joint);
  else
    findTrees();
  return joint;
}

void Scene::createJoint(JointSlot* slot) {
  const JointSpec& spec = slot->spec;
  const dBodyID child = bodies_[spec.child].ode;
  const dBodyID parent = spec.parent == WORLD_BODY ? nullptr : bodies_[spec.parent].ode;
  const Pose X_WJ = (spec.parent == WORLD_BODY ? Pose::Identity() : bodyState(spec.parent).X_WB) * spec.X_PJ;
  const Vector3 origin = X_WJ.translation(), axis = X_WJ.linear() * spec.axis;
  if (spec.kind == JointKind::FIXED) {
    slot->joint = dJointCreateFixed(world_, nullptr);
    dJointAttach(slot->joint, child, parent);
    dJointSetFixed(slot->joint);
  } else if (spec.kind == JointKind::REVOLUTE) {
    slot->joint = dJointCreateHinge(world_, nullptr);
    dJointAttach(slot->joint, child, parent);
    dJointSetHingeAnchor(slot->joint, origin.x(), origin.y(), origin.z());
    dJointSetHingeAxis(slot->joint, axis.x(), axis.y(), axis.z());
  } else {
    slot->joint = dJointCreateSlider(world_, nullptr);
    dJointAttach(slot->joint, child, parent);
    dJointSetSliderAxis(slot->joint, axis.x(), axis.y(), axis.z());
  }
  dJointSetFeedback(slot->joint, &slot->joint_feedback);
  if (spec.kind != JointKind::FIXED) createMotor(slot, child, parent, axis);
}

// Motors and friction have rows of their own: ODE turns a motor that shares a row with an active stop into a plain force.
void Scene::createMotor(JointSlot* slot, dBodyID child, dBodyID parent, const Vector3& axis) {
  const bool turns = slot->spec.kind == JointKind::REVOLUTE;
  slot->motor = turns ? dJointCreateAMotor(world_, nullptr) : dJointCreateLMotor(world_, nullptr);
  dJointAttach(slot->motor, child, parent);
  if (turns) {
    dJointSetAMotorMode(slot->motor, dAMotorUser);
    dJointSetAMotorNumAxes(slot->motor, MOTOR_ROWS);
  } else {
    dJointSetLMotorNumAxes(slot->motor, MOTOR_ROWS);
  }
  constexpr int FIXED_TO_CHILD = 1;
  for (int row = 0; row < MOTOR_ROWS; ++row) {
    if (turns)
      dJointSetAMotorAxis(slot->motor, row, FIXED_TO_CHILD, axis.x(), axis.y(), axis.z());
    else
      dJointSetLMotorAxis(slot->motor, row, FIXED_TO_CHILD, axis.x(), axis.y(), axis.z());
  }
  dJointSetFeedback(slot->motor, &slot->motor_feedback);
}

}  // namespace blem_sim::dynamics
