// Bodies, joints, contacts and drives as plain data: what a world is asked with and answers with.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "blem_sim/geometry/triangle_mesh.h"
#include "blem_sim/geometry/types.h"

namespace blem_sim::dynamics {

constexpr int WORLD_BODY = -1;  ///< the static world where a body is asked for

/** A rigid body. Its frame B is wherever its maker put it (a link's frame, a mesh's frame); the centre of mass may be elsewhere. */
struct BodySpec {
  std::string name;                   ///< "model::link"
  geometry::MassProperties inertial;  ///< mass > 0, com and inertia in B's axes, inertia about the com
  Pose X_WB = Pose::Identity();
};

enum class JointKind { FIXED, REVOLUTE, PRISMATIC };

/** A joint between two bodies, or a body and the world. Position 0 is where the child's frame C coincides with the joint frame J. */
struct JointSpec {
  std::string name;  ///< "model::joint"
  JointKind kind = JointKind::REVOLUTE;
  int parent = WORLD_BODY;
  int child = 0;
  Pose X_PJ = Pose::Identity();                             ///< joint frame in the parent body's frame (or the world)
  Vector3 axis = Vector3::UnitZ();                          ///< unit, in J; child's motion relative to the parent is along/about +axis
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad or m]
  double upper = std::numeric_limits<double>::infinity();
  /** q = multiplier * q[mimic_joint] + offset, if mimic_joint >= 0. */
  int mimic_joint = -1;
  double mimic_multiplier = 1, mimic_offset = 0;
  double armature = 0;  ///< [kg m^2 or kg] inertia of the motor's rotor, seen at the joint; only `articulated` knows it
};

struct BodyState {
  Pose X_WB = Pose::Identity();
  Vector3 v_WCom = Vector3::Zero();  ///< [m/s] of the centre of mass, world axes
  Vector3 w_WB = Vector3::Zero();    ///< [rad/s] world axes
};

struct JointState {
  double position = 0;  ///< [rad or m], counts full turns
  double velocity = 0;
  double effort = 0;  ///< [N m or N] of the motor alone, along the axis, in the last step
};

/** Drive of one joint during one step. All terms act together. */
struct JointDrive {
  double effort = 0;          ///< [N m or N] of the motor, given in advance: explicit PID, already capped
  double outside_effort = 0;  ///< [N m or N] beside the motor's
  /** Implicit PD: stiffness (target_position - q) + damping (target_velocity - qdot), both taken at the end of the step, bounded by
   *  max_effort. Stable for any gain. Off while both gains are 0. */
  double stiffness = 0, damping = 0, target_position = 0, target_velocity = 0;
  double max_effort = std::numeric_limits<double>::infinity();
  /** [rad/s or m/s] The implicit PD moves no joint beyond these velocities: within max_effort, its effort is at most
   *  velocity_gain (max_velocity - v), at least velocity_gain (min_velocity - v). */
  double min_velocity = -std::numeric_limits<double>::infinity(), max_velocity = std::numeric_limits<double>::infinity();
  double velocity_gain = std::numeric_limits<double>::infinity();  ///< [N m s/rad or N s/m]
  double dry_friction = 0;      ///< [N m or N] mu_D: sticks up to it, slips against it [Hauser 2013, 4.1]
  double viscous_friction = 0;  ///< mu_V

  /** [N m or N] known before the step is solved. */
  double givenEffort() const { return effort + outside_effort; }
};

/**
 * Drive of a free root over the ground during one step, against nothing: the velocity of its centre of mass along x and y and its spin
 * about z, world axes, come to targets at the end of the step, as far as force and torque reach. For `articulated`.
 */
struct RootDrive {
  int body = 0;                                        ///< that no joint moves, nor another of these drives
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< [m/s]
  double spin = 0;                                     ///< [rad/s]
  double max_force = 0, max_torque = 0;                ///< [N] along x and along y, [N m]
};

/** A contact that goes on under another id (ContactConstraint::id). */
struct ContactRename {
  std::uint64_t from, to;
  bool turned;  ///< the body that was A is B there
};
using ContactRenames = std::vector<ContactRename>;

/** One contact as the solver takes it. */
struct ContactConstraint {
  int body_a = WORLD_BODY, body_b = WORLD_BODY;
  Vector3 point = Vector3::Zero(), normal_BA = Vector3::Zero();  ///< world
  double depth = 0;                                              ///< [m], negative = gap
  double rolling = 0;             ///< [m] radius on which it rolls over both bodies; 0: it stands on one point of a body. For `articulated`
  Vector3 rim = Vector3::Zero();  ///< world: axis of a cylinder that rolls on the lowest point of a rim, as long as the rim's radius [m];
                                  ///< zero: none does. For `articulated`
  double friction = 0, restitution = 0;
  double impact_friction_factor = 1;  ///< 0 to 1: friction in impacts over friction; only `articulated` knows it
  double impact_friction_speed = 0;   ///< [m/s] closing speed up to which that factor does not act
  double stiffness = std::numeric_limits<double>::infinity(), damping = std::numeric_limits<double>::infinity();
  std::uint64_t id = 0;  ///< identity across steps, unique within one step (colliders and features)
};

struct SolverSettings {
  std::string stepper = "articulated";  ///< a name in stepperTable()
  std::optional<int> threads;  ///< that share a step's islands, large islands' loops (`articulated`) and pairs; nothing: threadsFor()
  int quick_step_iterations = 50;
  double cfm = 1e-6;                  ///< constraint force mixing of contacts in ODE's steppers
  double correction_fraction = 0.2;   ///< of a contact's depth removed per step, at most at max_correction_speed
  double max_correction_speed = 0.1;  ///< [m/s]
  double joint_erp = 0.2;
  double joint_cfm = 1e-10;
};

constexpr int MOST_CHOSEN_THREADS = 2;  ///< more were not measured
constexpr std::size_t CROWDED = 1000;   ///< contacts of a step that takes one thread a millisecond or more

/** Threads that share a step of so many contacts: as many as were asked for; if no number was, two for CROWDED ones, else one. Their number
 *  does not show in the result. */
inline int threadsFor(std::optional<int> asked, std::size_t contacts) {
  return asked.value_or(contacts < CROWDED ? 1 : MOST_CHOSEN_THREADS);
}

/** The largest number that threadsFor() gives for any step. */
inline int mostThreads(std::optional<int> asked) { return asked.value_or(MOST_CHOSEN_THREADS); }

/** Result of one solve; lives until the next one. Indices go with the constraints, joints, bodies given. */
struct SolveResult {
  std::vector<Vector3> contact_forces;  ///< [N] on body A, world axes, mean over the step
  std::vector<Wrench> joint_wrenches;   ///< from the parent on the child, world axes, about the joint frame's origin at the start of
                                        ///< the step; from motion (Newton-Euler over the step), not from a residual
  std::vector<double> motor_efforts;    ///< [N m or N] of the motors alone, along the axes
  std::vector<Wrench> root_wrenches;    ///< of root drives, mean over the step, about the body's centre of mass; empty: none were given
  std::vector<double> axis_efforts;     ///< [N m or N] of motors, outside efforts, friction and mimic joints' pull along the axes
  std::vector<double> free_efforts;     ///< [N m or N] what joints took along their axes to keep their velocities on a free way, which
                                        ///< axis_efforts of the next step hold, less what those of this one hold of the last
                                        ///< way's; empty: none known
  std::vector<double> apparent_work;    ///< [J] per contact: apparent work, at most, of departures and slips that loads end within the
                                        ///< step, and of bent paths; empty where a stepper does not know it
  std::vector<Vector3> free_ways;       ///< [m] per body: by how much its centre of mass went beside the way of the mean velocity over what
                                        ///< forces did to it, where a tree was followed on its free way, or flew through a part of a
                                        ///< step; empty if none was
  std::vector<double> free_work;        ///< [J] per joint: what it took to keep its velocity on a free way, which the next step pays, less
                                  ///< what this one paid of the last; what its effort did beside its mean velocity's way; empty: none known
  std::vector<double> free_speeds;  ///< [rad/s or m/s] per joint: by how much its velocity at the end of a free way is above the mean one
                                    ///< of that way; 0 where its tree was not followed; empty: none known
  double residual = 0;              ///< [N] largest miss of Coulomb's law by a contact's force; 0 where a stepper does not know it
  double creep = 0;       ///< [rad/s or m/s] largest miss of velocities to momentum's balance, contacts, sticking joints, limits or loops
  int iterations = 0;     ///< of the solver, over all islands
  int lcp_errors = 0;     ///< the complementarity solver complained; the step was redone with more CFM
  bool too_fast = false;  ///< joints or bodies turned too far in the step for their free motion to be followed: shorten dt
  bool finite = true;     ///< step gave a finite state; if not, bodies stay as before it and nothing else here means anything
};

/** Everything a world needs to replay bit for bit. */
struct WorldState {
  std::vector<double> numbers;
  std::vector<std::uint64_t> words;
  bool operator==(const WorldState& o) const { return numbers == o.numbers && words == o.words; }
};

}  // namespace blem_sim::dynamics
