#include "contacts/constraints/constraint_maker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::sim {
namespace {

// Pierced contacts part at this speed; a load on them slows them down by its weight over this rate times the lighter model's mass.
constexpr double SEPARATION_SPEED = 0.1;  // [m/s]
constexpr double SEPARATION_RATE = 1e4;   // [1/s]

/** Unit, world: axis of a cylinder on a body. */
Vector3 axisOf(const SimulatedWorld& world, const contact::Collider& cylinder) {
  const Pose X_BK = cylinder.X_BC * cylinder.geometry->cylinder()->X_GK;
  return world.world.bodyState(cylinder.body).X_WB.linear() * X_BK.linear().col(2);
}

/** Constraint of a contact, rigid, without friction. */
dynamics::ContactConstraint constraintOf(const SimulatedWorld& world, const contact::ContactManifold& manifold,
                                         const contact::Contact& contact) {
  const contact::Collider &a = world.colliders[manifold.a], &b = world.colliders[manifold.b];
  dynamics::ContactConstraint constraint;
  constraint.body_a = a.body;
  constraint.body_b = b.body;
  constraint.point = contact.point;
  constraint.normal_BA = contact.normal_BA;
  constraint.depth = contact.depth;
  constraint.rolling = contact::rollingRadius(a, b, contact);
  for (const bool is_a : {true, false}) {
    const contact::Collider& collider = is_a ? a : b;
    const double rim = contact::rimRadius(collider, contact.id, is_a);
    if (rim > 0) constraint.rim = rim * axisOf(world, collider);
  }
  constraint.id = worldContactId(manifold.a, manifold.b, contact.id);
  return constraint;
}

/** Mass [kg] of all bodies of the collider's model. */
double massOf(const SimulatedWorld& world, const contact::Collider& collider) {
  if (collider.body == dynamics::WORLD_BODY) return std::numeric_limits<double>::infinity();
  double mass = 0;
  for (const int body : world.models[collider.model].bodies)
    if (body != dynamics::WORLD_BODY) mass += world.world.bodySpec(body).inertial.mass;
  return mass;
}

/**
 * Share of a gap, from B's surface on, after which what is round has its point before touch: as the bodies will meet, the lighter one goes
 * most of the way. So friction turns a ball that lands by its radius, whichever part of a step is left to the landing.
 */
double meetingShare(const SimulatedWorld& world, const contact::Collider& a, const contact::Collider& b) {
  return 1 / (1 + massOf(world, a) / massOf(world, b));
}

bool isCompliant(const contact::SurfaceProperties& surface) { return std::isfinite(surface.stiffness) && std::isfinite(surface.damping); }

/** Makes a contact of meshes that cross a damper that lets go at SEPARATION_SPEED and never bounces: such contacts may contradict each
 *  other. */
void separate(double mass, double layer, dynamics::ContactConstraint* contact) {
  contact->damping = SEPARATION_RATE * mass;
  contact->stiffness = SEPARATION_SPEED * contact->damping / std::max(layer, contact->depth);
  contact->restitution = 0;
}

const reduction::Reduction* reductionNamed(const std::string& name) {
  const reduction::Reduction* method = reduction::findReduction(name);
  if (method) return method;
  std::string names;
  for (const reduction::Reduction& row : reduction::reductionTable()) names += (names.empty() ? "" : ", ") + std::string(row.name);
  throw InputError("contact.reduction: '" + name + "' is not known; take one of " + names);
}

}  // namespace

ConstraintMaker::ConstraintMaker(const ContactConfig& config, StepThreads* threads)
    : config_(config), threads_(threads), method_(reductionNamed(config.reduction)), meetings_(threads) {}

std::vector<std::uint64_t> ConstraintMaker::forget(int collider) {
  std::vector<std::uint64_t> ids;
  for (const reduction::ReductionMemory* memory : {&std::as_const(memory_), &stops_.memory()}) {
    for (const reduction::ReductionMemory::Choice& choice : memory->choices()) {
      if (choice.a != collider && choice.b != collider) continue;
      for (const std::uint64_t id : choice.ids) {
        const std::uint64_t known_as = worldContactId(choice.a, choice.b, id);
        ids.push_back(memory == &memory_ ? known_as : stopId(known_as));
      }
    }
  }
  memory_.forget(collider);
  stops_.forget(collider);
  return ids;
}

/** @param all contacts of the pair, of which the manifold's were kept */
void ConstraintMaker::addConstraints(const SolveAhead& ahead, const contact::ContactManifold& all, contact::ContactManifold& manifold) {
  const SimulatedWorld& world = ahead.world;
  const contact::Collider &a = world.colliders[manifold.a], &b = world.colliders[manifold.b];
  const contact::SurfaceProperties surface = contact::combineSurfaces(a.surface, b.surface, config_.friction_rule);
  if (std::isfinite(surface.stiffness) || std::isfinite(surface.damping)) reduction::weighSprings(manifold.contacts, &workspace_);
  const bool recovers = ahead.contacts.crossings.find(manifold.a, manifold.b) != nullptr;
  const double share = meetingShare(world, a, b);
  for (const contact::Contact& contact : manifold.contacts) {
    dynamics::ContactConstraint constraint = constraintOf(world, manifold, contact);
    if (constraint.rolling > 0 && contact.depth < 0) constraint.point -= (share - 0.5) * contact.depth * contact.normal_BA;
    constraint.friction = surface.friction;
    constraint.restitution = surface.restitution;
    constraint.impact_friction_factor = surface.impact_friction_factor;
    constraint.impact_friction_speed = surface.impact_friction_speed;
    constraint.stiffness = contact.weight * surface.stiffness;
    constraint.damping = contact.weight * surface.damping;
    if (recovers && contact.depth > 0) separate(std::min(massOf(world, a), massOf(world, b)), manifold.layer, &constraint);
    made_.constraints.push_back(constraint);
    made_.solved.push_back(
        {manifold.a, manifold.b, contact.id, manifold.layer, contact.pierced, 0, recovers, bears(world, manifold, contact)});
  }
  made_.reduced += static_cast<int>(manifold.contacts.size());
  if (!recovers && isCompliant(surface)) addStops(world, all, surface.friction);
}

void ConstraintMaker::addStops(const SimulatedWorld& world, const contact::ContactManifold& all, double friction) {
  const double stop = LayerStops::STOP * all.layer;
  for (const contact::Contact& contact : stops_.choose(all, *method_, &workspace_)) {
    dynamics::ContactConstraint constraint = constraintOf(world, all, contact);
    constraint.friction = friction;
    constraint.id = stopId(constraint.id);
    made_.constraints.push_back(constraint);
    made_.solved.push_back({all.a, all.b, contact.id, all.layer, false, stop, false, true});
  }
}

void ConstraintMaker::reduce(const SimulatedWorld& world, const std::vector<contact::ContactManifold>& manifolds) {
  for (contact::ContactManifold& manifold : reduced_) manifold.contacts.clear();  // a pair without contacts now keeps none
  model_a_.clear();
  model_b_.clear();
  for (const contact::ContactManifold& manifold : manifolds) {
    model_a_.push_back(world.colliders[manifold.a].model);
    model_b_.push_back(world.colliders[manifold.b].model);
  }
  threads_->with([&] {
    made_.loss = reduction::reduceManifolds({manifolds, model_a_, model_b_, world.budgets}, *method_, &memory_, &workspace_, &reduced_);
  });
}

const SolverContacts& ConstraintMaker::make(const SolveAhead& ahead, std::vector<contact::ContactManifold>* manifolds) {
  meetings_.look(ahead);
  meetings_.exchange(manifolds);
  reduce(ahead.world, *manifolds);
  made_.constraints.clear();
  made_.solved.clear();
  made_.reduced = 0;
  stops_.start();
  for (std::size_t m = 0; m < reduced_.size(); ++m) addConstraints(ahead, (*manifolds)[m], reduced_[m]);
  stops_.remember();
  meetings_.exchange(manifolds);
  return made_;
}

}  // namespace blem_sim::sim
