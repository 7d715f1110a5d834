#include "contacts/motion/body_ways.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::sim {
namespace {

constexpr int NO_JOINT = dynamics::WORLD_BODY - 1;
constexpr double BALANCED = 1e-6;  // [m] of a rotor's centre of mass off its axis; of its moment of inertia
constexpr double STRAIGHT = 1e-6;  // [rad] turn of a screw whose bend is none

/** Whether the child's spin about a hinge moves no mass and turns no moment. The axis goes through the child's origin. */
bool isBalanced(const dynamics::JointSpec& hinge, const geometry::MassProperties& child) {
  const Vector3 moment = child.inertia * hinge.axis;
  return hinge.kind == dynamics::JointKind::REVOLUTE && child.com.cross(hinge.axis).norm() < BALANCED &&
         moment.cross(hinge.axis).norm() < BALANCED * moment.norm();
}

/** Motion of poses of the world for dt [s] by a constant screw, whose point at p moves at v [m/s]. */
Pose screwMotion(const Vector3& p, const Vector3& v, const Vector3& w, double dt) {
  const double angle = dt * w.norm();
  const Vector3 axis = angle > 0 ? w.normalized() : Vector3::UnitZ(), way = dt * v, along = axis.dot(way) * axis;
  const Matrix3 turn = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  Vector3 bent = way;
  if (angle > 0) bent = along + (std::sin(angle) * (way - along) + (1 - std::cos(angle)) * axis.cross(way)) / angle;
  Pose motion = Pose::Identity();
  motion.linear() = turn;
  motion.translation() = p + bent - turn * p;
  return motion;
}

/** Constant screw of a motion of poses of the world, within dt [s], seen from a centre of mass [m] at its start. */
BodyTwist screwOf(const Pose& motion, const Vector3& com, double dt) {
  const Eigen::AngleAxisd turn(motion.linear());
  const Vector3 axis = turn.axis(), way = motion * com - com;
  BodyTwist screw{com, way / dt, turn.angle() / dt * axis};
  if (turn.angle() < STRAIGHT) return screw;
  const Vector3 along = axis.dot(way) * axis, across = way - along;
  screw.centre = com + 0.5 * across + 0.5 / std::tan(0.5 * turn.angle()) * axis.cross(across);
  screw.v = along / dt;
  return screw;
}

}  // namespace

void BodyWays::start(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, double dt) {
  world_ = &world;
  bodies_ = &bodies;
  dt_ = dt;
  findParents();
}

// A joint that closes a loop leads nothing: the first one of a body does.
void BodyWays::findParents() {
  parents_.assign(bodies_->size(), NO_JOINT);
  swings_.assign(bodies_->size(), 0);
  rotors_.assign(bodies_->size(), Vector3::Zero());
  for (const RobotInfo& robot : world_->robots) {
    const ModelInfo& model = world_->models[robot.model];
    if (!model.alive) continue;
    for (const int joint : robot.world_joints) {
      if (joint < 0) continue;
      const dynamics::JointSpec& spec = world_->world.jointSpec(joint);
      if (parents_[spec.child] == NO_JOINT) parents_[spec.child] = spec.parent;
    }
    findRotors(robot);
    const double swing = swingOf(model);
    for (const int body : model.bodies) swings_[body] = swing;
  }
}

void BodyWays::findRotors(const RobotInfo& robot) {
  for (const int joint : robot.world_joints) {
    if (joint < 0) continue;
    const dynamics::JointSpec& spec = world_->world.jointSpec(joint);
    if (isBalanced(spec, world_->world.bodySpec(spec.child).inertial)) rotors_[spec.child] = spec.axis;
  }
  for (const int joint : robot.world_joints)
    if (joint >= 0 && world_->world.jointSpec(joint).parent != dynamics::WORLD_BODY)
      rotors_[world_->world.jointSpec(joint).parent].setZero();
}

/** [rad/s] Turn of a link that swings its tree. */
double BodyWays::turnOf(int body) const {
  const Vector3& w = (*bodies_)[body].w_WB;
  const int parent = parents_[body];
  if (parent == NO_JOINT || rotors_[body].isZero(0)) return w.norm();
  const Vector3 axis = (*bodies_)[body].X_WB.linear() * rotors_[body];
  const Vector3 spin = parent == dynamics::WORLD_BODY ? w : Vector3(w - (*bodies_)[parent].w_WB);
  return (w - spin.dot(axis) * axis).norm();
}

double BodyWays::swingOf(const ModelInfo& model) const {
  double turn = 0, size = 0;
  for (const int body : model.bodies) {
    turn = std::max(turn, turnOf(body));
    size = std::max(size, 2 * (twist(body).centre - twist(model.bodies[0]).centre).norm());
  }
  return dt_ * turn * turn * size;
}

BodyTwist BodyWays::twist(int body) const { return twistOf(*world_, *bodies_, body); }

/** Motion of a body until the end of the solve, by which poses of the world are moved. Seen from its parent, a body on a joint moves by a
 * constant screw. */
Pose BodyWays::ahead(int body) const {
  const int parent = body == dynamics::WORLD_BODY ? NO_JOINT : parents_[body];
  const BodyTwist own = twist(body);
  if (parent == NO_JOINT) return own.moved(Pose::Identity(), dt_);
  const BodyTwist of_parent = twist(parent);
  const Vector3 w = own.w - of_parent.w, v = own.v - of_parent.at(own.centre);
  return ahead(parent) * screwMotion(own.centre, v, w, dt_);
}

bool BodyWays::isOnJoint(int body) const { return body != dynamics::WORLD_BODY && parents_[body] != NO_JOINT; }

void BodyWays::lead(int body, BodyTwist* way) const {
  if (isOnJoint(body)) *way = screwOf(ahead(body), twist(body).centre, dt_);
}

void BodyWays::leadTo(int body, const Pose& X_WB, BodyTwist* way) const {
  if (isOnJoint(body)) *way = screwOf(X_WB * (*bodies_)[body].X_WB.inverse(), twist(body).centre, dt_);
}

}  // namespace blem_sim::sim
