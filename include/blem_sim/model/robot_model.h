// A robot as plain const data, read from URDF: links, joints, collision shapes.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "blem_sim/geometry/cylinder.h"
#include "blem_sim/model/gazebo_blocks.h"

namespace blem_sim::model {

/** Mass [kg], centre of mass [m] and inertia [kg m^2] about the centre of mass, both in the axes of the frame they are given in. */
using Inertial = geometry::MassProperties;

/** One collision shape. Spheres are a point, capsules a segment, with their radius as boundary; all else is a mesh of triangles, whose
 * cylinder is known where it stands for one. */
struct CollisionShape {
  std::shared_ptr<const geometry::TriangleMesh> mesh;  ///< in the link's frame, scaled and cleaned
  double radius = 0;                                   ///< [m] > 0: this is the boundary, exactly; 0: the configured boundary width applies
  std::optional<geometry::Cylinder> cylinder;          ///< that the mesh stands for
  geometry::MeshReport report;
};

struct LinkModel {
  std::string name;
  std::optional<Inertial> inertial;  ///< in the link's frame; absent if the URDF gives none
  std::vector<CollisionShape> collisions;
};

enum class JointType { FIXED, REVOLUTE, CONTINUOUS, PRISMATIC, PLANAR, FLOATING };

struct JointLimits {
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad or m]
  double upper = std::numeric_limits<double>::infinity();
  double effort = std::numeric_limits<double>::infinity();    ///< [N m or N]
  double velocity = std::numeric_limits<double>::infinity();  ///< [rad/s or m/s]
};

/** URDF safety_controller: bounds of a motor's drive before the joint's limits. */
struct SafetyController {
  double lower = 0, upper = 0;  ///< [rad or m] soft limits; without a range between them they bound nothing
  double k_position = 0;        ///< [1/s] the motor drives towards a soft limit at k_position times the way that is left, at most
  double k_velocity = 0;  ///< [N m s/rad or N s/m] its effort is k_velocity times what is left of that velocity, at most; 0: unbounded
};

/** q = multiplier * q[joint] + offset */
struct Mimic {
  std::string joint;
  double multiplier = 1;
  double offset = 0;
};

struct JointModel {
  std::string name;
  JointType type = JointType::FIXED;
  int parent = -1;                  ///< index of the parent link
  int child = -1;                   ///< index of the child link; its frame is the joint frame at q = 0
  Pose X_PJ = Pose::Identity();     ///< joint frame in the parent link
  Vector3 axis = Vector3::UnitX();  ///< unit, in the joint frame (planar: the plane's normal)
  JointLimits limits;
  double dry_friction = 0;      ///< [N m or N], URDF dynamics/friction
  double viscous_friction = 0;  ///< [N m s/rad or N s/m], URDF dynamics/damping
  std::optional<Mimic> mimic;
  std::optional<SafetyController> safety;
};

/** URDF transmission between an actuator and a joint. Commands and efforts are the joint's; actuators turn `reduction` times as far. */
struct Transmission {
  std::string name, joint;
  double reduction = 1;  ///< not 0
  double offset = 0;     ///< [rad or m] of the joint where the actuator is at 0
};

/** A kinematic tree. Joints are sorted so that every joint comes after the joint that moves its parent; otherwise in the file's order. */
struct RobotModel {
  std::string name;
  std::string source;  ///< file or parameter, for error texts
  std::vector<LinkModel> links;
  std::vector<JointModel> joints;
  std::vector<Transmission> transmissions;
  std::vector<GazeboBlock> gazebo;  ///< `<gazebo>` blocks in the file's order
  int root = 0;                     ///< index of the root link
  std::vector<std::string> notes;   ///< repairs and parts left out, in words

  int linkIndex(const std::string& link) const;    ///< -1 if there is none
  int jointIndex(const std::string& joint) const;  ///< -1 if there is none
  /** The first transmission of a joint; null if it has none. */
  const Transmission* transmissionOf(const std::string& joint) const;
};

/** Place of a link on a rigid body of a LumpedRobot. */
struct LinkPlacement {
  int body = 0;
  Pose X_BL = Pose::Identity();  ///< link frame in the body's frame
};

/** A rigid body: links joined by fixed joints. Its frame is the frame of its first link, for which it is named. */
struct LumpedBody {
  std::string name;
  std::vector<int> links;  ///< indices into RobotModel::links, first = frame
  Inertial inertial;       ///< in the body's frame; always positive mass and positive definite inertia unless the body is the fixed base
};

struct LumpedJoint {
  std::string name;                   ///< the URDF joint's; a planar joint becomes three: NAME/x, NAME/y, NAME/yaw
  JointType type = JointType::FIXED;  ///< FIXED (kept for a sensor), REVOLUTE, CONTINUOUS, PRISMATIC or FLOATING
  int parent = 0, child = 0;          ///< bodies
  Pose X_PJ = Pose::Identity();       ///< joint frame in the parent body's frame
  Vector3 axis = Vector3::UnitX();    ///< unit, in the joint frame; the child body's frame is the joint frame at q = 0
  JointLimits limits;
  double dry_friction = 0, viscous_friction = 0;
  std::optional<Mimic> mimic;
  std::optional<SafetyController> safety;

  /** True for hinges and sliders, which have a position. */
  bool moves() const { return type != JointType::FIXED && type != JointType::FLOATING; }
  /** Pose of the child body in the parent body at position q [rad or m]. */
  Pose pose(double q) const;
};

/** The robot as rigid bodies and moving joints, parents first; body 0 holds the root link. */
struct LumpedRobot {
  std::vector<LumpedBody> bodies;
  std::vector<LumpedJoint> joints;            ///< joint i moves a body; sorted parents first
  std::vector<LinkPlacement> link_placement;  ///< one per link of the RobotModel
  std::vector<std::string> notes;
  double mass() const;
};

/** Joint at the head of a chain of joints that mimic each other: a follower's position is multiplier * that of `joint` + offset. */
struct MimicLeader {
  int joint = -1;  ///< of the robot's joints; -1: one that it does not have
  double multiplier = 1, offset = 0;
};
/** @param follower one of the robot's joints that mimic another */
MimicLeader mimicLeader(const LumpedRobot& robot, const LumpedJoint& follower);

/**
 * Lumps links that are joined by fixed joints, except across the joints named in `keep` (a force-torque sensor sits there; names of other
 * joints change nothing). The two virtual bodies of a planar joint weigh a thousandth of the body they carry and have no links.
 * A body without any inertial gets one from its collision shapes at 1000 kg/m^3 (or 0.01 kg, 1 cm, without a shape) and a note.
 * A joint that others follow is bounded to where their limits let it go, with a note; limits that would leave it no way are not kept.
 * @throws InputError if a moving body's mass is given as zero or negative, or its inertia is not positive definite beyond repair.
 */
LumpedRobot lumpFixedJoints(const RobotModel& robot, const std::set<std::string>& keep, bool fixed_base);

}  // namespace blem_sim::model
