#include "energy_balance.h"

#include <algorithm>
#include <cmath>

namespace blem_sim {
namespace {

/** [J] kinetic and potential. */
double bodiesEnergy(const World& world) { return world.kineticEnergy() + world.potentialEnergy(); }

/** [J] that of the bodies, given, and of rotors. */
double mechanicalEnergy(const World& world, double bodies) {
  double energy = bodies;
  for (int joint = 0; joint < world.jointCount(); ++joint) {
    const double armature = world.jointSpec(joint).armature;
    if (armature > 0) energy += 0.5 * armature * std::pow(world.jointState(joint).velocity, 2);
  }
  return energy;
}

/**
 * [J] by which potential energy rises more slowly half a step earlier. Steppers move bodies by the velocity at a step's end, while kinetic
 * energy changes by forces times mean velocity; without this, flight would lose m g^2 dt^2 / 2 a step and a bounce gain it back.
 */
double gravityLag(const World& world, double dt, const std::vector<BodyState>& before, const std::vector<BodyState>& after) {
  double lag = 0;
  for (std::size_t b = 0; b < after.size(); ++b)
    lag += world.bodySpec(static_cast<int>(b)).inertial.mass * world.gravity().dot(after[b].v_WCom - before[b].v_WCom);
  return 0.5 * dt * lag;
}

bool recovers(const ContactStage& contacts, const SolvedContact& contact) {
  const std::vector<Recovery>& all = contacts.recoveries();
  return std::any_of(all.begin(), all.end(),
                     [&contact](const Recovery& r) { return r.a == contact.collider_a && r.b == contact.collider_b; });
}

/** How points of bodies were moved; contacts of one body follow on each other. */
class Displacements {
 public:
  Displacements(const std::vector<BodyState>& before, const std::vector<BodyState>& after) : before_(before), after_(after) {}

  Vector3 of(const Vector3& point, int body) {
    if (body == WORLD_BODY) return Vector3::Zero();
    if (body != last_) X_BW_before_ = before_[body].X_WB.inverse();
    last_ = body;
    return after_[body].X_WB * (X_BW_before_ * point) - point;
  }

 private:
  const std::vector<BodyState>&before_, &after_;
  int last_ = WORLD_BODY;
  Pose X_BW_before_;
};

/** [J] by which the energy in springs of compliant contacts rises; the springs that part crossed meshes are none. */
double springEnergyRise(const ContactStage& contacts, const std::vector<BodyState>& before, const std::vector<BodyState>& after) {
  double rise = 0;
  Displacements a(before, after), b(before, after);
  for (std::size_t i = 0; i < contacts.constraints().size(); ++i) {
    const ContactConstraint& contact = contacts.constraints()[i];
    if (!std::isfinite(contact.stiffness) || !std::isfinite(contact.damping) || recovers(contacts, contacts.solved()[i])) continue;
    const Vector3 apart = a.of(contact.point, contact.body_a) - b.of(contact.point, contact.body_b);
    const double depth_before = std::max(0.0, contact.depth);
    const double depth_after = std::max(0.0, contact.depth - contact.normal_BA.dot(apart));
    rise += 0.5 * contact.stiffness * (depth_after * depth_after - depth_before * depth_before);
  }
  return rise;
}

double largestRestitution(const ContactStage& contacts, const std::vector<Vector3>& forces) {
  double largest = 0;
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (!forces[i].isZero(0)) largest = std::max(largest, contacts.constraints()[i].restitution);
  return largest;
}

}  // namespace

void EnergyBalance::start(const World& world) {
  bodies_ = bodiesEnergy(world);
  energy_ = mechanicalEnergy(world, bodies_);
  joints_.resize(world.jointCount());
  for (int joint = 0; joint < world.jointCount(); ++joint) joints_[joint] = world.jointState(joint);
}

// With effort times mean velocity, for the same reason as gravityLag.
double EnergyBalance::takeWork(const World& world, double dt) {
  double work = 0;
  for (int joint = 0; joint < world.jointCount(); ++joint) {
    const JointState state = world.jointState(joint);
    JointState& last = joints_[joint];
    work += state.effort * (state.position - last.position - 0.5 * dt * (state.velocity - last.velocity));
    last = state;
  }
  return work;
}

double EnergyBalance::addSolve(const World& world, double dt, const ContactStage& contacts, const std::vector<Vector3>& forces,
                               const std::vector<BodyState>& before, const std::vector<BodyState>& after) {
  bodies_ = bodiesEnergy(world);
  const double energy = mechanicalEnergy(world, bodies_);
  const double rise =
      energy - energy_ + gravityLag(world, dt, before, after) + springEnergyRise(contacts, before, after) - takeWork(world, dt);
  energy_ = energy;
  const double gained = std::max(0.0, rise - bounce_);
  bounce_ = std::max(0.0, -rise) * std::pow(largestRestitution(contacts, forces), 2);
  return gained;
}

}  // namespace blem_sim
