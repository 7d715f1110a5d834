#include "contacts/constraints/early_pushes.h"

#include <algorithm>
#include <cstdint>

#include "blem_sim/contact/collider_pairs.h"

namespace blem_sim::sim {
namespace {

constexpr double ALIKE = 0.1;  // sine

bool isOfRobot(const SimulatedWorld& world, int collider) {
  const contact::Collider& c = world.colliders[collider];
  return c.body != dynamics::WORLD_BODY && world.models[c.model].kind == ModelKind::ROBOT;
}

bool touchedBefore(const contact::ContactManifold* before, std::uint64_t id) {
  return before && std::any_of(before->contacts.begin(), before->contacts.end(),
                               [id](const contact::Contact& contact) { return contact.id == id && touches(contact); });
}

/** Whether a pair touches at the end of a solve, along a normal, where it did not at its start. */
bool touchesAnew(const contact::ContactManifold* before, const contact::ContactManifold* after, const Vector3& normal_BA) {
  return after && std::any_of(after->contacts.begin(), after->contacts.end(), [&](const contact::Contact& contact) {
           return touches(contact) && !touchedBefore(before, contact.id) && (contact.normal_BA - normal_BA).norm() < ALIKE;
         });
}

}  // namespace

bool EarlyPushes::isEarly(const SimulatedWorld& world, const MadeSolve& made, const FoundContacts& found, std::size_t constraint) const {
  const dynamics::ContactConstraint& contact = made.contacts.constraints[constraint];
  const SolvedContact& of = made.contacts.solved[constraint];
  if (of.pierced || of.recovers || (!isOfRobot(world, of.collider_a) && !isOfRobot(world, of.collider_b))) return false;
  const Vector3 sliding =
      twistOf(world, made.after, contact.body_a).at(contact.point) - twistOf(world, made.after, contact.body_b).at(contact.point);
  const Vector3 across = sliding - contact.normal_BA.dot(sliding) * contact.normal_BA;
  if (across.norm() * made.dt <= ACROSS * of.layer) return false;
  return !touchesAnew(contact::findPair(made.start.manifolds, of.collider_a, of.collider_b),
                      contact::findPair(found.manifolds, of.collider_a, of.collider_b), contact.normal_BA);
}

bool EarlyPushes::find(const SimulatedWorld& world, const MadeSolve& made, const FoundContacts& found) {
  clear();
  std::vector<PairAside>& pairs = expectation_.pairs;
  const std::vector<Vector3>& forces = made.result.contact_forces;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (made.contacts.solved[i].bears || forces[i].isZero(0)) continue;
    const PairAside pair{made.contacts.solved[i].collider_a, made.contacts.solved[i].collider_b};
    const bool known = !pairs.empty() && pairs.back().a == pair.a && pairs.back().b == pair.b;
    if (!known && isEarly(world, made, found, i)) pairs.push_back(pair);
  }
  return !pairs.empty();
}

void EarlyPushes::clear() {
  expectation_.pairs.clear();
  expectation_.bodies.clear();
}

}  // namespace blem_sim::sim
