#include "contact_stage.h"

#include <algorithm>

#include "blem_sim/contact/narrow_phase.h"
#include "blem_sim/contact/reduction.h"
#include "blem_sim/geometry/input_error.h"

namespace blem_sim {
namespace {

// Contacts exist before touch, so that none appears with a force: at rest within this of the layer, sooner at speed.
constexpr double BASE_MARGIN = 0.001;  // [m]
constexpr double MAX_MARGIN = 0.1;     // [m]: 66 m/s at 1 ms
// Forces may speed a body up during the step; its margin covers this times its present motion.
constexpr double REACH_FACTOR = 1.5;

/** Farthest corner of the geometry's box from the body's centre of mass. */
double armOf(const Collider& collider, const Vector3& com) {
  if (!collider.geometry || collider.geometry->isHalfSpace()) return 0;
  const Box& box = collider.geometry->bounds();
  double arm = 0;
  for (int corner = 0; corner < 8; ++corner)
    arm = std::max(arm, (collider.X_BC * box.corner(static_cast<Box::CornerType>(corner)) - com).norm());
  return arm;
}

std::uint64_t mixed(std::uint64_t x) {  // splitmix64's finalizer [Steele 2014]
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/** Identity of a contact among those of all pairs. */
std::uint64_t contactId(const ContactManifold& manifold, const Contact& contact) {
  return mixed(contact.id + mixed((static_cast<std::uint64_t>(manifold.a) << 32) + static_cast<std::uint64_t>(manifold.b) + 1));
}

const Reduction* reductionNamed(const std::string& name) {
  const Reduction* method = findReduction(name);
  if (method) return method;
  std::string names;
  for (const Reduction& row : reductionTable()) names += (names.empty() ? "" : ", ") + std::string(row.name);
  throw InputError("contact.reduction: '" + name + "' is not known; take one of " + names);
}

}  // namespace

ContactStage::ContactStage(const ContactConfig& config) : config_(config), method_(reductionNamed(config.reduction)) {}

void ContactStage::moveColliders(const SimulatedWorld& world, double dt) {
  const std::vector<Collider>& colliders = world.colliders;
  for (std::size_t i = arms_.size(); i < colliders.size(); ++i) {
    const int body = colliders[i].body;
    arms_.push_back(body == WORLD_BODY ? 0 : armOf(colliders[i], world.world.bodySpec(body).inertial.com));
  }
  const double fall = 0.5 * world.world.gravity().norm() * dt * dt;
  motion_.resize(colliders.size());
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    if (colliders[i].body == WORLD_BODY) {
      motion_[i] = {colliders[i].X_BC, 0};
      continue;
    }
    const BodyState state = world.world.bodyState(colliders[i].body);
    const double speed = state.v_WCom.norm() + state.w_WB.norm() * arms_[i];
    motion_[i] = {state.X_WB * colliders[i].X_BC, REACH_FACTOR * speed * dt + fall};
  }
}

void ContactStage::broadPhase(const SimulatedWorld& world, double dt) {
  moveColliders(world, dt);
  pairs_ = blem_sim::broadPhase(world.colliders, motion_, world.filter, BASE_MARGIN, MAX_MARGIN);
}

void ContactStage::narrowPhase(const SimulatedWorld& world) {
  std::size_t count = 0;
  for (const ColliderPair& pair : pairs_) {
    if (world.disabled_pairs.count({pair.a, pair.b}) > 0) continue;
    if (count == found_.size()) found_.emplace_back();
    ContactManifold& manifold = found_[count];
    blem_sim::narrowPhase(world.colliders[pair.a], motion_[pair.a].X_WC, world.colliders[pair.b], motion_[pair.b].X_WC, pair.margin,
                          &manifold);
    manifold.a = pair.a;
    manifold.b = pair.b;
    manifold.layer = world.colliders[pair.a].radius + world.colliders[pair.b].radius;
    if (!manifold.contacts.empty()) ++count;
  }
  found_.resize(count);
}

void ContactStage::accept() {
  std::swap(current_, found_);
  known_ = true;
}

int ContactStage::rawContacts() const {
  int count = 0;
  for (const ContactManifold& manifold : current_) count += static_cast<int>(manifold.contacts.size());
  return count;
}

void ContactStage::addConstraints(const SimulatedWorld& world, const ContactManifold& manifold) {
  const Collider &a = world.colliders[manifold.a], &b = world.colliders[manifold.b];
  const SurfaceProperties surface = combineSurfaces(a.surface, b.surface, config_.friction_rule);
  for (const Contact& contact : manifold.contacts) {
    ContactConstraint constraint;
    constraint.body_a = a.body;
    constraint.body_b = b.body;
    constraint.point = contact.point;
    constraint.normal_BA = contact.normal_BA;
    constraint.depth = contact.depth;
    constraint.friction = surface.friction;
    constraint.restitution = surface.restitution;
    constraint.stiffness = surface.stiffness;
    constraint.damping = surface.damping;
    constraint.id = contactId(manifold, contact);
    constraints_.push_back(constraint);
    solved_.push_back({manifold.a, manifold.b, manifold.layer, contact.pierced});
  }
}

void ContactStage::reduction(const SimulatedWorld& world) {
  reduced_ = current_;
  std::vector<int> model_a, model_b;
  for (const ContactManifold& manifold : reduced_) {
    model_a.push_back(world.colliders[manifold.a].model);
    model_b.push_back(world.colliders[manifold.b].model);
  }
  const int left_out = reduceManifolds(reduced_, model_a, model_b, world.budgets, *method_);
  constraints_.clear();
  solved_.clear();
  std::vector<int> counts(world.models.size(), 0);
  for (std::size_t m = 0; m < reduced_.size(); ++m) {
    addConstraints(world, reduced_[m]);
    counts[model_a[m]] += static_cast<int>(reduced_[m].contacts.size());
    if (model_b[m] != model_a[m]) counts[model_b[m]] += static_cast<int>(reduced_[m].contacts.size());
  }
  budget_used_up_ = false;
  for (std::size_t model = 0; model < counts.size(); ++model)
    budget_used_up_ = budget_used_up_ || (left_out > 0 && counts[model] >= world.budgets[model].max_contacts);
}

}  // namespace blem_sim
