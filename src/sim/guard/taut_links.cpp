#include "guard/taut_links.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace blem_sim::sim {
namespace {

constexpr double FOREVER = std::numeric_limits<double>::infinity();
constexpr double MOST_TURN = 1.5;  // [rad] rate times length of a solve: 2 is where swings begin to grow

/** A link and the two free hinges that it is in tension between. */
struct TautLink {
  double pull = 0;     ///< [N m] tension times length
  double inertia = 0;  ///< [kg m^2] about the middle, across
  double damping = 0;  ///< [N m s/rad] of the less damped hinge
};

/** Origin of a joint's frame in the world. */
Vector3 originOf(const dynamics::JointSpec& joint, const MadeSolve& made) {
  const Vector3& p = joint.X_PJ.translation();
  return joint.parent < 0 ? p : made.before[joint.parent].X_WB * p;
}

/** [kg m^2] Least inertia about an axis across `along`, about a point of the body. */
double inertiaAcross(const dynamics::BodySpec& body, const Pose& X_WB, const Vector3& point, const Vector3& along) {
  const geometry::MassProperties& mass = body.inertial;
  const Vector3 lever = X_WB * mass.com - point;
  const Matrix3 about_com = X_WB.linear() * mass.inertia * X_WB.linear().transpose();
  const Matrix3 about_point = about_com + mass.mass * (lever.squaredNorm() * Matrix3::Identity() - lever * lever.transpose());
  const Vector3 side = along.unitOrthogonal(), other = along.cross(side);
  const double a = side.dot(about_point * side), b = other.dot(about_point * other), c = side.dot(about_point * other);
  return 0.5 * (a + b) - std::hypot(0.5 * (a - b), c);
}

TautLink linkBetween(const dynamics::World& world, const MadeSolve& made, int inner, int outer) {
  const dynamics::JointSpec &in = world.jointSpec(inner), &out = world.jointSpec(outer);
  const Vector3 from = originOf(in, made), to = originOf(out, made);
  const double length = (to - from).norm();
  if (!(length > 0)) return {};
  const Vector3 along = (to - from) / length;
  // The parent pulls the link back, the child pulls it forth: so does the link pull the child back.
  const double back = -made.result.joint_wrenches[inner].force.dot(along), forth = -made.result.joint_wrenches[outer].force.dot(along);
  TautLink link;
  link.pull = length * std::max(0.0, std::min(back, forth));
  link.inertia = inertiaAcross(world.bodySpec(in.child), made.before[in.child].X_WB, 0.5 * (from + to), along) +
                 4 * std::min(in.armature, out.armature);
  link.damping = std::min(made.drives[inner].viscous_friction, made.drives[outer].viscous_friction);
  return link;
}

/** [s] Longest solve, h, that a link can take: h^2 pull is MOST_TURN^2 times its inertia and twice its damping times h. */
double longestOf(const TautLink& link) {
  if (!(link.pull > 0)) return FOREVER;
  const double damping = MOST_TURN * MOST_TURN * link.damping, inertia = MOST_TURN * MOST_TURN * link.inertia;
  return (damping + std::sqrt(damping * damping + inertia * link.pull)) / link.pull;
}

bool isFree(const dynamics::World& world, const std::vector<dynamics::JointDrive>& drives, int joint) {
  if (!world.hasJoint(joint)) return false;
  const dynamics::JointDrive& drive = drives[joint];
  const dynamics::JointSpec& spec = world.jointSpec(joint);
  return drive.stiffness == 0 && drive.damping == 0 && spec.kind == dynamics::JointKind::REVOLUTE && spec.mimic_joint < 0;
}

}  // namespace

void TautLinks::findHinges(const dynamics::World& world, const MadeSolve& made) {
  hinges_.clear();
  for (int joint = 0; joint < world.jointCount(); ++joint)
    if (isFree(world, made.drives, joint)) hinges_.push_back(joint);
  if (hinges_.size() < 2) return;
  inner_.assign(world.bodyCount(), -1);
  for (const int hinge : hinges_) inner_[world.jointSpec(hinge).child] = hinge;
}

void TautLinks::findTouched(const dynamics::World& world, const MadeSolve& made) {
  trees_.start(world.bodyCount());
  for (int joint = 0; joint < world.jointCount(); ++joint)
    if (world.hasJoint(joint)) trees_.tie(world.jointSpec(joint).parent, world.jointSpec(joint).child);
  is_touched_.assign(world.bodyCount(), made.result.too_fast ? 1 : 0);
  const std::vector<dynamics::ContactConstraint>& contacts = made.contacts.constraints;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (!made.result.contact_forces[i].isZero(0))
      for (const int body : {contacts[i].body_a, contacts[i].body_b})
        if (body >= 0) is_touched_[trees_.islandOf(body)] = 1;
}

double TautLinks::longestSolve(const dynamics::World& world, const MadeSolve& made) {
  findHinges(world, made);
  if (hinges_.size() < 2) return FOREVER;
  findTouched(world, made);
  double longest = FOREVER;
  for (const int outer : hinges_) {
    const int body = world.jointSpec(outer).parent;
    if (body < 0 || inner_[body] < 0 || !is_touched_[trees_.islandOf(body)]) continue;
    longest = std::min(longest, longestOf(linkBetween(world, made, inner_[body], outer)));
  }
  return longest;
}

}  // namespace blem_sim::sim
