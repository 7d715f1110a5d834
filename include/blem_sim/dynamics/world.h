// Bodies, joints and one step of time: the ODE world behind plain data.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "blem_sim/dynamics/world_types.h"

namespace blem_sim::dynamics {

/**
 * Bodies and joints in an ODE world. Deterministic: same calls, same bits. Not thread safe.
 * Indices returned by add functions stay valid until the thing is removed; the next one added gets the lowest free index.
 */
class World {
 public:
  World(const Vector3& gravity, const SolverSettings& settings);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  int addBody(const BodySpec& spec);
  /** Precondition: parents' poses are consistent with X_PJ at the position given. @param position present q [rad or m] */
  int addJoint(const JointSpec& spec, double position = 0);
  /** Takes a body and its joints out of the world; joints that mimic one of these are free then. */
  void removeBody(int body);
  /** Takes a joint out of the world; joints that mimic it are free then. */
  void removeJoint(int joint);
  /**
   * Contacts with these ids (ContactConstraint::id) are strangers in the next step.
   * @param go_on those that are known there under another id: the old one and the new one of each
   */
  void forgetContacts(std::vector<std::uint64_t> ids, const ContactRenames& go_on = {});
  /** Whether the contact of this id pushed in the last step. */
  bool pushed(std::uint64_t contact) const;

  int bodyCount() const;  ///< slots, removed ones included
  int jointCount() const;
  bool hasBody(int body) const;  ///< false: the slot is free
  bool hasJoint(int joint) const;
  const BodySpec& bodySpec(int body) const;
  const JointSpec& jointSpec(int joint) const;

  BodyState bodyState(int body) const;
  void setBodyState(int body, const BodyState& state);
  JointState jointState(int joint) const;
  /** Sets the position that the joint's bodies' poses stand for, after setBodyState; keeps count of full turns. */
  void resetJointPosition(int joint, double position);
  /**
   * Gives a body other mass properties, where it is and as it moves.
   * @throws InputError if they are no body's, nothing being changed
   */
  void setInertial(int body, const geometry::MassProperties& inertial);
  /** Precondition: lower <= upper. @param lower, upper [rad or m] */
  void setJointLimits(int joint, double lower, double upper);
  /** Sets JointState::effort, the motor's, of every joint [N m or N] until the next step, for steps that are made of several of the
   * world's. */
  void setJointEfforts(const std::vector<double>& efforts);

  const Vector3& gravity() const;
  void setGravity(const Vector3& gravity);

  /** Adds an outside wrench for the next step only: force [N] and torque [N m] in world axes, at a point of the world. */
  void applyWrench(int body, const Wrench& wrench, const Vector3& point);

  /**
   * Advances by dt [s] > 0. With numbers that are none or out of range the result is not finite.
   * @param drives one per joint slot @param of_step [s] step of which dt is a part, by half of which velocities stand before their poses in
   * flight, for `articulated`; less than dt: dt @param root_drives of this step, beside them
   */
  const SolveResult& step(double dt, const std::vector<ContactConstraint>& contacts, const std::vector<JointDrive>& drives,
                          double of_step = 0, const std::vector<RootDrive>& root_drives = {});

  double kineticEnergy() const;    ///< [J]
  double potentialEnergy() const;  ///< [J] against gravity, zero at the origin

  /** Forgets all steps: the next one is made as the first of a world with the bodies where they are. */
  void forgetHistory();

  WorldState save() const;
  /** The same into a state that is used again. */
  void save(WorldState* state) const;
  /** Restores a saved state. Precondition: it is of a world with the same bodies and joints. */
  void restore(const WorldState& state);
  /**
   * The same for a state that comes from outside.
   * @throws InputError in one line, nothing being changed: it is of other bodies or joints, is cut short, counts more than it can hold, or
   * its numbers cannot be those of bodies
   */
  void restoreChecked(const WorldState& state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/** Names of the steppers: world_step, quick_step, articulated. */
std::vector<std::string> stepperNames();

}  // namespace blem_sim::dynamics
