#include "soak/world_figures.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace blem_sim {
namespace {

Pose poseOf(const dynamics::World& world, int body) { return body == dynamics::WORLD_BODY ? Pose::Identity() : world.bodyState(body).X_WB; }

Matrix3 inertiaInWorld(const dynamics::World& world, int body, const Pose& X_WB) {
  return X_WB.linear() * world.bodySpec(body).inertial.inertia * X_WB.linear().transpose();
}

double angleBetween(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

Pose jointFrame(const dynamics::World& world, int joint) {
  const dynamics::JointSpec& spec = world.jointSpec(joint);
  return poseOf(world, spec.parent) * spec.X_PJ;
}

double jointGap(const dynamics::World& world, int joint) {
  const dynamics::JointSpec& spec = world.jointSpec(joint);
  const Pose X_WJ = jointFrame(world, joint);
  const Vector3 gap = poseOf(world, spec.child).translation() - X_WJ.translation();
  if (spec.kind != dynamics::JointKind::PRISMATIC) return gap.norm();
  return gap.cross(X_WJ.linear() * spec.axis).norm();
}

double jointTilt(const dynamics::World& world, int joint) {
  const dynamics::JointSpec& spec = world.jointSpec(joint);
  const Matrix3 parent = jointFrame(world, joint).linear(), child = poseOf(world, spec.child).linear();
  if (spec.kind == dynamics::JointKind::REVOLUTE) return angleBetween(parent * spec.axis, child * spec.axis);
  return std::max(angleBetween(parent.col(0), child.col(0)), angleBetween(parent.col(1), child.col(1)));
}

double worstJointGap(const dynamics::World& world) {
  double worst = 0;
  for (int j = 0; j < world.jointCount(); ++j) worst = std::max(worst, jointGap(world, j));
  return worst;
}

double worstJointTilt(const dynamics::World& world) {
  double worst = 0;
  for (int j = 0; j < world.jointCount(); ++j) worst = std::max(worst, jointTilt(world, j));
  return worst;
}

Vector3 bodyCom(const dynamics::World& world, int body) { return world.bodyState(body).X_WB * world.bodySpec(body).inertial.com; }

double totalMass(const dynamics::World& world, const std::vector<int>& bodies) {
  double mass = 0;
  for (const int b : bodies) mass += world.bodySpec(b).inertial.mass;
  return mass;
}

Vector3 centreOfMass(const dynamics::World& world, const std::vector<int>& bodies) {
  Vector3 sum = Vector3::Zero();
  for (const int b : bodies) sum += world.bodySpec(b).inertial.mass * bodyCom(world, b);
  return sum / totalMass(world, bodies);
}

Vector3 momentum(const dynamics::World& world, const std::vector<int>& bodies) {
  Vector3 sum = Vector3::Zero();
  for (const int b : bodies) sum += world.bodySpec(b).inertial.mass * world.bodyState(b).v_WCom;
  return sum;
}

Vector3 angularMomentum(const dynamics::World& world, const std::vector<int>& bodies, const Vector3& about) {
  Vector3 sum = Vector3::Zero();
  for (const int b : bodies) {
    const dynamics::BodyState state = world.bodyState(b);
    sum += (bodyCom(world, b) - about).cross(world.bodySpec(b).inertial.mass * state.v_WCom);
    sum += inertiaInWorld(world, b, state.X_WB) * state.w_WB;
  }
  return sum;
}

double innerKineticEnergy(const dynamics::World& world, const std::vector<int>& bodies) {
  const Vector3 velocity = momentum(world, bodies) / totalMass(world, bodies);
  double energy = 0;
  for (const int b : bodies) {
    const dynamics::BodyState state = world.bodyState(b);
    energy += 0.5 * world.bodySpec(b).inertial.mass * (state.v_WCom - velocity).squaredNorm();
    energy += 0.5 * state.w_WB.dot(inertiaInWorld(world, b, state.X_WB) * state.w_WB);
  }
  return energy;
}

std::vector<dynamics::BodyState> bodyStates(const dynamics::World& world) {
  std::vector<dynamics::BodyState> states;
  for (int b = 0; b < world.bodyCount(); ++b) states.push_back(world.bodyState(b));
  return states;
}

Wrench neededWrench(const dynamics::World& world, const std::vector<dynamics::BodyState>& before, const std::vector<int>& bodies, double dt,
                    const Vector3& about) {
  Wrench sum;
  for (const int b : bodies) {
    const geometry::MassProperties& inertial = world.bodySpec(b).inertial;
    const dynamics::BodyState now = world.bodyState(b);
    const Vector3 force = inertial.mass * ((now.v_WCom - before[b].v_WCom) / dt - world.gravity());
    const Matrix3 inertia = inertiaInWorld(world, b, before[b].X_WB);
    sum.force += force;
    sum.torque += (before[b].X_WB * inertial.com - about).cross(force) + inertia * (now.w_WB - before[b].w_WB) / dt +
                  before[b].w_WB.cross(inertia * before[b].w_WB);
  }
  return sum;
}

void setJointSpeeds(dynamics::World* world, int root, const std::vector<double>& speeds, const Vector3& v, const Vector3& w) {
  std::vector<Vector3> origin_velocity(world->bodyCount(), Vector3::Zero()), spin(world->bodyCount(), Vector3::Zero());
  const auto set = [&](int body) {
    dynamics::BodyState state = world->bodyState(body);
    state.w_WB = spin[body];
    state.v_WCom = origin_velocity[body] + spin[body].cross(state.X_WB.linear() * world->bodySpec(body).inertial.com);
    world->setBodyState(body, state);
  };
  origin_velocity[root] = v;
  spin[root] = w;
  set(root);
  for (int j = 0; j < world->jointCount(); ++j) {
    const dynamics::JointSpec& spec = world->jointSpec(j);
    const Vector3 axis = jointFrame(*world, j).linear() * spec.axis;
    const Vector3 arm = poseOf(*world, spec.child).translation() - poseOf(*world, spec.parent).translation();
    const bool fixed_parent = spec.parent == dynamics::WORLD_BODY;
    spin[spec.child] = fixed_parent ? Vector3::Zero() : spin[spec.parent];
    origin_velocity[spec.child] = fixed_parent ? Vector3::Zero() : Vector3(origin_velocity[spec.parent] + spin[spec.parent].cross(arm));
    if (spec.kind == dynamics::JointKind::REVOLUTE) spin[spec.child] += axis * speeds[j];
    if (spec.kind == dynamics::JointKind::PRISMATIC) origin_velocity[spec.child] += axis * speeds[j];
    set(spec.child);
  }
}

double rmsJointSpeed(const dynamics::World& world) {
  double sum = 0;
  int moving = 0;
  for (int j = 0; j < world.jointCount(); ++j) {
    if (world.jointSpec(j).kind == dynamics::JointKind::FIXED) continue;
    sum += std::pow(world.jointState(j).velocity, 2);
    ++moving;
  }
  return moving ? std::sqrt(sum / moving) : 0;
}

std::uint64_t hashOf(const dynamics::WorldState& state) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  const auto mix = [&](std::uint64_t word) {
    for (int i = 0; i < 8; ++i, word >>= 8) hash = (hash ^ (word & 255)) * 1099511628211u;
  };
  for (const double number : state.numbers) {
    std::uint64_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    mix(bits);
  }
  for (const std::uint64_t word : state.words) mix(word);
  return hash;
}

}  // namespace blem_sim
