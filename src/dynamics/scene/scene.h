// The one store of bodies and joints: an ODE world with a body per BodySpec at its centre of mass, a joint and its motors per JointSpec.
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <deque>
#include <set>
#include <vector>

#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/geometry/state_stream.h"
#include "scene/ode_library.h"

namespace blem_sim::dynamics {

inline Vector3 fromOde(const dReal* v) { return {v[0], v[1], v[2]}; }
inline Quaternion quaternionFromOde(const dReal* q) { return {q[0], q[1], q[2], q[3]}; }
inline Matrix3 rotationFromOde(const dReal* R) {
  Matrix3 out;
  out << R[0], R[1], R[2], R[4], R[5], R[6], R[8], R[9], R[10];
  return out;
}

/** A body's state as ODE holds it: written back, it is the same to the last bit (ODE's setters would normalise). */
struct BodyBits {
  static constexpr int SIZE = 25;
  double numbers[SIZE];  ///< com in world 3, quaternion w first 4, rotation 3 rows of 4, velocity of com 3, angular velocity 3

  Vector3 com() const { return fromOde(numbers); }
  Matrix3 rotation() const { return rotationFromOde(numbers + 7); }
  Vector3 velocity() const { return fromOde(numbers + 19); }
  Vector3 spin() const { return fromOde(numbers + 22); }
  Quaternion turn() const { return quaternionFromOde(numbers + 3); }
  /** @param R orthonormal */
  void set(const Vector3& com, const Matrix3& R, const Vector3& velocity, const Vector3& spin);
};

struct BodySlot {
  BodySpec spec;
  dBodyID ode = nullptr;  ///< null once removed
  Wrench pending;         ///< outside wrench for the next step, world axes, about the com
};

struct JointSlot {
  JointSpec spec;
  dJointID joint = nullptr;  ///< hinge, slider or fixed; null once removed
  dJointID motor = nullptr;  ///< angular or linear motor along the axis: implicit PD, viscous and dry friction; null if fixed
  dJointFeedback joint_feedback = {}, motor_feedback = {};
  BodyBits child_assembled = {}, parent_assembled = {};  ///< states of the bodies when ODE took the joint's geometry
  double assembled_position = 0;                         ///< q there, where ODE's own coordinate is 0
  Quaternion assembled_turn = Quaternion::Identity();    ///< of the child against the parent there
  Vector3 parent_axis = Vector3::UnitZ();                ///< in the parent's frame
  double last_position = 0;                              ///< q at the end of the last step: tells the full turns
  double last_effort = 0;                                ///< of the motor, along the axis, in the last step
  bool in_tree = true;                                   ///< false: closes a loop
  std::uint64_t occupant = 0;                            ///< a number that no other joint of the scene ever has; 0 once removed
};

/** Bodies and joints. Indices are slots; a new body or joint takes the lowest empty one. */
class Scene {
 public:
  Scene(const Vector3& gravity, const SolverSettings& settings);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  int addBody(const BodySpec& spec);
  int addJoint(const JointSpec& spec, double position);
  void removeBody(int body);
  void removeJoint(int joint);
  /** Gives a body other mass properties; its frame and that frame's motion stay. @throws InputError before anything is changed */
  void setInertial(int body, const geometry::MassProperties& inertial);
  /** Replaces the ODE world, which an internal error left unusable, by a new one from the slots. */
  void rebuild(const std::vector<BodyBits>& state);

  dWorldID ode() const { return world_; }
  /** The group of this step's contact joints; its user fills and empties it. */
  dJointGroupID contactGroup() const { return contact_group_; }
  std::vector<BodySlot>& bodies() { return bodies_; }
  const std::vector<BodySlot>& bodies() const { return bodies_; }
  std::deque<JointSlot>& joints() { return joints_; }
  const std::deque<JointSlot>& joints() const { return joints_; }
  /** Joints of the kinematic trees, a body's own joint after those of its children. */
  const std::vector<int>& leavesFirst() const;

  /** Number of changes of the set of bodies and joints. */
  std::uint64_t structure() const { return structure_; }

  const Vector3& gravity() const { return gravity_; }
  void setGravity(const Vector3& gravity);

  bool exists(int body) const { return body >= 0 && body < static_cast<int>(bodies_.size()) && bodies_[body].ode; }
  BodyBits bits(int body) const;
  /** Whether the body's state is the same to the last bit. */
  bool hasBits(int body, const BodyBits& bits) const;
  Vector3 com(int body) const { return fromOde(dBodyGetPosition(bodies_[body].ode)); }
  Matrix3 rotation(int body) const { return rotationFromOde(dBodyGetRotation(bodies_[body].ode)); }
  Vector3 velocity(int body) const { return fromOde(dBodyGetLinearVel(bodies_[body].ode)); }
  Vector3 spin(int body) const { return fromOde(dBodyGetAngularVel(bodies_[body].ode)); }
  void setBits(int body, const BodyBits& bits);
  void bits(std::vector<BodyBits>* out) const;
  void setBits(const std::vector<BodyBits>& bits);
  BodyState bodyState(int body) const;
  void setBodyState(int body, const BodyState& state);

  /** Bodies, and the positions of joints that the next step goes on from. */
  void save(geometry::StateWriter* writer) const;
  /** Refuses a state of other numbers of bodies or joints. */
  void restore(geometry::StateReader* reader);

 private:
  void createWorld();
  void createBody(BodySlot* slot);
  void createJointWhereAssembled(JointSlot* slot);
  /** Makes ODE's joint anew after a centre of mass has moved. */
  void recreateJoint(JointSlot* slot);
  void createJoint(JointSlot* slot);
  void createMotor(JointSlot* slot, dBodyID child, dBodyID parent, const Vector3& axis);
  void emptyJoint(int joint);
  void placeInTree(int joint);
  void findTrees();
  void orderJoints() const;

  OdeLibrary library_;
  SolverSettings settings_;
  Vector3 gravity_;
  dWorldID world_ = nullptr;
  dThreadingImplementationID threading_ = nullptr;
  dJointGroupID contact_group_ = nullptr;
  std::vector<BodySlot> bodies_;
  std::deque<JointSlot> joints_;  ///< a deque, as ODE holds pointers to the feedbacks
  std::set<int> free_bodies_, free_joints_;
  std::uint64_t joints_added_ = 0;
  std::vector<int> tree_parent_;  ///< per body: parent of its joint of a tree, WORLD_BODY too
  std::vector<char> has_parent_;  ///< per body: it has such a joint
  // Caches that follow from the joints, made on demand.
  mutable bool ordered_ = true;
  mutable std::vector<int> leaves_first_, depth_;
  std::uint64_t structure_ = 0;
};

}  // namespace blem_sim::dynamics
