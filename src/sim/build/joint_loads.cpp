#include "build/joint_loads.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::sim {
namespace {

constexpr double SAG_ANGLE = 1e-3;                 // [rad] by which weight and friction turn a joint at most; smaller is stiffer
constexpr double SAG_LENGTH = 1e-4;                // [m] the same for sliders
constexpr double LEAST_FREQUENCY = 2 * M_PI * 10;  // [rad/s] of a joint and what its child carries

/** Mass, first and second moments about the origin of the robot's root; they add. */
struct Moments {
  double mass = 0;
  Vector3 first = Vector3::Zero();
  Matrix3 second = Matrix3::Zero();

  Moments() = default;
  Moments(const Pose& X_RB, const model::Inertial& inertial) : mass(inertial.mass) {
    const Vector3 com = X_RB * inertial.com;
    first = mass * com;
    second = X_RB.linear() * inertial.inertia * X_RB.linear().transpose() +
             mass * (com.squaredNorm() * Matrix3::Identity() - com * com.transpose());
  }
  Moments& operator+=(const Moments& o) {
    mass += o.mass;
    first += o.first;
    second += o.second;
    return *this;
  }
  Moments operator-(const Moments& o) const {
    Moments rest = *this;
    rest.mass -= o.mass;
    rest.first -= o.first;
    rest.second -= o.second;
    return rest;
  }
};

/** A joint's axis in the frame of the robot's root. */
struct Axis {
  bool turns = true;
  Vector3 point, direction;
};

JointSide sideOf(const Moments& m, const Axis& axis, double gravity) {
  if (!axis.turns) return {m.mass, m.mass * gravity};
  const Vector3& a = axis.direction;
  const Vector3 arm = a.cross(axis.point);
  const double inertia = a.dot(m.second * a) - 2 * arm.dot(a.cross(m.first)) + m.mass * arm.squaredNorm();
  return {std::max(0.0, inertia), gravity * a.cross(m.first - m.mass * axis.point).norm()};
}

std::vector<Pose> bodyPoses(const model::LumpedRobot& robot, const std::vector<double>& positions) {
  std::vector<Pose> X_RB(robot.bodies.size(), Pose::Identity());
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const model::LumpedJoint& joint = robot.joints[j];
    X_RB[joint.child] = X_RB[joint.parent] * joint.pose(positions[j]);
  }
  return X_RB;
}

/** Per body: the moments of all that it carries, itself included. A floating body carries its own tree and is carried by nobody. */
std::vector<Moments> carriedMoments(const model::LumpedRobot& robot, const std::vector<Pose>& X_RB) {
  std::vector<Moments> carried;
  for (std::size_t b = 0; b < robot.bodies.size(); ++b) carried.emplace_back(X_RB[b], robot.bodies[b].inertial);
  for (auto joint = robot.joints.rbegin(); joint != robot.joints.rend(); ++joint)
    if (joint->type != model::JointType::FLOATING) carried[joint->parent] += carried[joint->child];
  return carried;
}

}  // namespace

std::vector<JointLoad> jointLoads(const model::LumpedRobot& robot, const std::vector<double>& positions, bool fixed_base, double gravity) {
  const std::vector<Pose> X_RB = bodyPoses(robot, positions);
  const std::vector<Moments> carried = carriedMoments(robot, X_RB);
  std::vector<int> root(robot.bodies.size(), 0);  // of each body's tree
  std::vector<JointLoad> loads(robot.joints.size());
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const model::LumpedJoint& joint = robot.joints[j];
    const bool floats = joint.type == model::JointType::FLOATING;
    root[joint.child] = floats ? joint.child : root[joint.parent];
    if (floats) continue;
    const Pose X_RJ = X_RB[joint.parent] * joint.X_PJ;
    const Axis axis{joint.type != model::JointType::PRISMATIC, X_RJ.translation(), X_RJ.linear() * joint.axis};
    loads[j].child = sideOf(carried[joint.child], axis, gravity);
    const int tree = root[joint.child];
    if (tree != 0 || !fixed_base) loads[j].rest = sideOf(carried[tree] - carried[joint.child], axis, gravity);
  }
  return loads;
}

double lightInertia(const JointLoad& load) {
  const double child = load.child.inertia, rest = load.rest.inertia;
  return rest > 0 ? child * rest / (child + rest) : child;
}

void addFollowers(const model::LumpedRobot& robot, std::vector<JointLoad>* loads) {
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    if (!robot.joints[j].mimic) continue;
    const model::MimicLeader leader = model::mimicLeader(robot, robot.joints[j]);
    const JointLoad& follower = (*loads)[j];
    JointLoad& load = (*loads)[leader.joint];
    const double ratio = std::abs(leader.multiplier);
    load.child.inertia += ratio * ratio * follower.child.inertia;
    load.child.weight += ratio * follower.child.weight;
    load.friction += ratio * follower.friction;
  }
}

JointGains computedGains(const JointLoad& load, const model::LumpedJoint& joint, double effort_limit) {
  constexpr double SQUARED = LEAST_FREQUENCY * LEAST_FREQUENCY;
  const double sag = joint.type == model::JointType::PRISMATIC ? SAG_LENGTH : SAG_ANGLE;
  const double held = std::min(std::max(load.child.weight, load.rest.weight) + load.friction, effort_limit);
  JointGains gains;
  gains.p = std::max(held / sag, load.child.inertia * SQUARED);
  // A motor too weak for the rest, such as a finger's, need not damp the rest: that would slow it down.
  const double damped = std::min(std::max(load.child.inertia, load.rest.inertia), gains.p / SQUARED);
  gains.d = 2 * std::sqrt(gains.p * damped);
  return gains;
}

}  // namespace blem_sim::sim
