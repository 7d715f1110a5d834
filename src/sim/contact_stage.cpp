#include "contact_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "blem_sim/contact/collider_pairs.h"
#include "blem_sim/contact/narrow_phase.h"
#include "blem_sim/contact/reduction.h"
#include "blem_sim/geometry/input_error.h"
#include "meeting_speed.h"

namespace blem_sim {
namespace {

// Contacts exist before touch, so that none appears with a force: at rest within this of the layer, sooner at speed. Less between small
// things: what lies around them would use up their budgets.
constexpr double BASE_MARGIN = 0.0005;         // [m], or
constexpr double BASE_MARGIN_OF_LENGTH = 0.1;  // of the shorter collider
// What is farther than this is not looked at: before it comes close, the step guard ends the substep.
constexpr double LEAST_MAX_MARGIN = 0.005;  // [m], or
constexpr double MAX_MARGIN_OF_LAYER = 2;   // layers
constexpr double UNGUARDED_MARGIN = 0.1;    // [m] where there is no layer, and over half-spaces: 66 m/s at 1 ms
// Forces may speed a body up during the step; a margin covers this times the present motion.
constexpr double REACH_FACTOR = 1.5;
// Pierced contacts part at this speed; what weighs on them slows them down by its weight over this rate times the lighter model's mass.
constexpr double SEPARATION_SPEED = 0.1;  // [m/s]
constexpr double SEPARATION_RATE = 1e4;   // [1/s]
constexpr double APART = 0.25;            // of the layer: what crossed is sound again when its deepest contact uses up less

constexpr int MOST_AT_ONE_PLACE = 8;  // pairs of a collider with others at its place (leftOut()) that are looked at

// Of a recovery in a saved state.
constexpr std::size_t WORDS = 3, NUMBERS = 16;

/** Farthest corner of the geometry's box from the body's centre of mass. */
double armOf(const Collider& collider, const Vector3& com) {
  if (!collider.geometry || collider.geometry->isHalfSpace()) return 0;
  const Box& box = collider.geometry->bounds();
  double arm = 0;
  for (int corner = 0; corner < 8; ++corner)
    arm = std::max(arm, (collider.X_BC * box.corner(static_cast<Box::CornerType>(corner)) - com).norm());
  return arm;
}

/** [m] of its box's longest edge, layers included. */
double lengthOf(const Collider& collider) {
  if (collider.geometry->isHalfSpace()) return std::numeric_limits<double>::infinity();
  return collider.geometry->bounds().sizes().maxCoeff() + 2 * collider.radius;
}

double baseMargin(const Collider& a, const Collider& b) {
  return std::min(BASE_MARGIN, BASE_MARGIN_OF_LENGTH * std::min(lengthOf(a), lengthOf(b)));
}

std::uint64_t mixed(std::uint64_t x) {  // splitmix64's finalizer [Steele 2014]
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/** Identity of a contact of a pair among those of all pairs. */
std::uint64_t contactId(int a, int b, std::uint64_t id) {
  return mixed(id + mixed((static_cast<std::uint64_t>(a) << 32) + static_cast<std::uint64_t>(b) + 1));
}

/** Rigid, without friction. */
ContactConstraint constraintOf(const SimulatedWorld& world, const ContactManifold& manifold, const Contact& contact) {
  ContactConstraint constraint;
  constraint.body_a = world.colliders[manifold.a].body;
  constraint.body_b = world.colliders[manifold.b].body;
  constraint.point = contact.point;
  constraint.normal_BA = contact.normal_BA;
  constraint.depth = contact.depth;
  constraint.id = contactId(manifold.a, manifold.b, contact.id);
  return constraint;
}

bool isRigid(const Pose& X) {
  constexpr double ROUNDING = 1e-6;
  return (X.linear() * X.linear().transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff() <= ROUNDING &&
         X.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1);
}

/** [kg] of all that moves with the collider. */
double massOf(const SimulatedWorld& world, const Collider& collider) {
  if (collider.body == WORLD_BODY) return std::numeric_limits<double>::infinity();
  double mass = 0;
  for (const int body : world.models[collider.model].bodies)
    if (body != WORLD_BODY) mass += world.world.bodySpec(body).inertial.mass;
  return mass;
}

/** A stop below a contact's spring, where it has one, is another contact. */
std::uint64_t stopId(std::uint64_t id) { return mixed(id); }

bool isCompliant(const SurfaceProperties& surface) { return std::isfinite(surface.stiffness) && std::isfinite(surface.damping); }

/** Where meshes cross, contacts may contradict each other: a damper that lets go at SEPARATION_SPEED, and never bounces. */
void separate(double mass, double layer, ContactConstraint* contact) {
  contact->damping = SEPARATION_RATE * mass;
  contact->stiffness = SEPARATION_SPEED * contact->damping / std::max(layer, contact->depth);
  contact->restitution = 0;
}

int countContacts(const std::vector<ContactManifold>& manifolds) {
  int count = 0;
  for (const ContactManifold& manifold : manifolds) count += static_cast<int>(manifold.contacts.size());
  return count;
}

const Reduction* reductionNamed(const std::string& name) {
  const Reduction* method = findReduction(name);
  if (method) return method;
  std::string names;
  for (const Reduction& row : reductionTable()) names += (names.empty() ? "" : ", ") + std::string(row.name);
  throw InputError("contact.reduction: '" + name + "' is not known; take one of " + names);
}

}  // namespace

ContactStage::ContactStage(const ContactConfig& config, int threads)
    : config_(config), method_(reductionNamed(config.reduction)), searches_(threads) {}

void ContactStage::moveColliders(const SimulatedWorld& world, const std::vector<BodyState>& bodies, double dt) {
  const std::vector<Collider>& colliders = world.colliders;
  for (std::size_t i = arms_.size(); i < colliders.size(); ++i) {
    const int body = colliders[i].body;
    arms_.push_back(body == WORLD_BODY ? 0 : armOf(colliders[i], world.world.bodySpec(body).inertial.com));
  }
  const double fall = 0.5 * world.world.gravity().norm() * dt * dt;
  std::vector<ColliderMotion>& motion = search_.motion;
  motion.resize(colliders.size());
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    if (colliders[i].body == WORLD_BODY) {
      motion[i] = {colliders[i].X_BC, 0};
      continue;
    }
    const BodyState& state = bodies[colliders[i].body];
    double speed = state.v_WCom.norm() + state.w_WB.norm() * arms_[i];
    if (faster_) {
      const BodyState& faster = (*faster_)[colliders[i].body];
      speed = std::max(speed, faster.v_WCom.norm() + faster.w_WB.norm() * arms_[i]);
    }
    motion[i] = {state.X_WB * colliders[i].X_BC, REACH_FACTOR * speed * dt + fall};
  }
}

/** WatchedPair::known: by how far two colliders can approach each other, moving on as they do, or if one of them is stopped dead. */
double ContactStage::knownMargin(const SimulatedWorld& world, const std::vector<BodyState>& bodies, const ColliderPair& pair,
                                 double dt) const {
  const Collider &a = world.colliders[pair.a], &b = world.colliders[pair.b];
  const double layer = a.radius + b.radius;
  const bool guarded = layer > 0 && !a.geometry->isHalfSpace() && !b.geometry->isHalfSpace();
  const double most = std::min(pair.margin, guarded ? std::max(LEAST_MAX_MARGIN, MAX_MARGIN_OF_LAYER * layer) : UNGUARDED_MARGIN);
  const double base = baseMargin(a, b);
  if (most <= base) return most;
  double speed = meetingSpeed(world, bodies, search_.motion, pair.a, pair.b, layer + pair.margin);
  if (faster_) speed = std::max(speed, meetingSpeed(world, *faster_, search_.motion, pair.a, pair.b, layer + pair.margin));
  const double alone = std::max(search_.motion[pair.a].reach, search_.motion[pair.b].reach) / REACH_FACTOR;
  return std::clamp(std::max(REACH_FACTOR * speed * dt, alone), base, most);
}

bool ContactStage::isAtOnePlace(const SimulatedWorld& world, int a, int b) const {
  const auto boxOf = [&](int collider) -> const Box& { return world.colliders[collider].geometry->bounds(); };
  for (const int collider : {a, b})
    if (!world.colliders[collider].geometry || world.colliders[collider].geometry->isHalfSpace()) return false;
  const Vector3 middle_a = search_.motion[a].X_WC * boxOf(a).center(), middle_b = search_.motion[b].X_WC * boxOf(b).center();
  const double smaller = std::min(boxOf(a).diagonal().squaredNorm(), boxOf(b).diagonal().squaredNorm());
  if ((middle_a - middle_b).squaredNorm() > 0.25 * smaller) return false;
  return boxOf(a).contains(search_.motion[a].X_WC.inverse() * middle_b) && boxOf(b).contains(search_.motion[b].X_WC.inverse() * middle_a);
}

void ContactStage::broadPhase(const SimulatedWorld& world, const std::vector<BodyState>& bodies, double dt) {
  moveColliders(world, bodies, dt);
  search_.pairs.clear();
  search_.left_out.clear();
  at_one_place_.assign(world.colliders.size(), 0);
  for (const ColliderPair& pair :
       pair_search_.find(world.colliders, search_.motion, world.filter, BASE_MARGIN, std::numeric_limits<double>::infinity())) {
    if (world.disabled_pairs.count({pair.a, pair.b}) > 0) continue;
    if (isAtOnePlace(world, pair.a, pair.b)) {
      if (at_one_place_[pair.a] >= MOST_AT_ONE_PLACE || at_one_place_[pair.b] >= MOST_AT_ONE_PLACE) {
        search_.left_out.push_back({pair.a, pair.b});
        continue;
      }
      ++at_one_place_[pair.a], ++at_one_place_[pair.b];
    }
    search_.pairs.push_back({pair.a, pair.b, pair.margin, knownMargin(world, bodies, pair, dt)});
  }
}

Recovery ContactStage::lastApart(int a, int b) const {
  if (const Recovery* recovery = findPair(current_search_.recoveries, a, b)) return *recovery;
  if (!known_ || findPair(current_search_.left_out, a, b)) return {a, b, false, Pose::Identity()};
  return {a, b, true, current_search_.motion[a].X_WC.inverse() * current_search_.motion[b].X_WC};
}

void ContactStage::narrowPhase(const SimulatedWorld& world) {
  const std::size_t pairs = search_.pairs.size();
  for (; found_.size() < pairs && !spare_.empty(); spare_.pop_back()) found_.push_back(std::move(spare_.back()));
  if (found_.size() < pairs) found_.resize(pairs);
  search_.recoveries.clear();
  for (const WatchedPair& pair : search_.pairs) search_.recoveries.push_back(lastApart(pair.a, pair.b));
  search_.flush.watch(world.colliders, search_.pairs);
  searches_.run(search_.pairs, [&](std::size_t i, NarrowPhaseMemory* memory) {
    const WatchedPair& pair = search_.pairs[i];
    const Recovery& last = search_.recoveries[i];
    blem_sim::narrowPhase(world.colliders[pair.a], search_.motion[pair.a].X_WC, world.colliders[pair.b], search_.motion[pair.b].X_WC,
                          pair.known, &found_[i], last.known ? &last.X_AB : nullptr, memory);
    found_[i].a = pair.a;
    found_[i].b = pair.b;
    search_.flush.dropCovered(world.colliders, search_.motion, &found_[i]);
  });
  keepWhatWasFound(pairs);
}

/** Manifolds with contacts, and the pairs that cross or are not apart yet. */
void ContactStage::keepWhatWasFound(std::size_t pairs) {
  std::size_t manifolds = 0, recoveries = 0;
  for (std::size_t i = 0; i < pairs; ++i) {
    const ContactManifold& manifold = found_[i];
    const bool was_recovering = findPair(current_search_.recoveries, manifold.a, manifold.b) != nullptr;
    if (manifold.pierced || (was_recovering && manifold.maxDepth() > APART * manifold.layer))
      search_.recoveries[recoveries++] = search_.recoveries[i];
    if (manifold.contacts.empty()) continue;
    if (manifolds != i) std::swap(found_[manifolds], found_[i]);
    ++manifolds;
  }
  for (; found_.size() > manifolds; found_.pop_back()) spare_.push_back(std::move(found_.back()));
  search_.recoveries.resize(recoveries);
}

void ContactStage::accept() {
  std::swap(current_, found_);
  std::swap(current_search_, search_);
  known_ = true;
}

void ContactStage::appendRecoveries(std::vector<double>* numbers, std::vector<std::uint64_t>* words) const {
  words->push_back(current_search_.recoveries.size());
  for (const Recovery& recovery : current_search_.recoveries) {
    for (const int word : {recovery.a, recovery.b, static_cast<int>(recovery.known)}) words->push_back(static_cast<std::uint64_t>(word));
    numbers->insert(numbers->end(), recovery.X_AB.matrix().data(), recovery.X_AB.matrix().data() + NUMBERS);
  }
}

bool ContactStage::readRecoveries(const std::vector<Collider>& colliders, const std::uint64_t** words, const std::uint64_t* words_end,
                                  NumberReader* reader, std::vector<Recovery>* recoveries) {
  if (*words == words_end) return false;
  const std::uint64_t count = *(*words)++;
  if (static_cast<std::uint64_t>(words_end - *words) / WORDS < count) return false;
  for (std::uint64_t i = 0; i < count; ++i, *words += WORDS) {
    if (!isPair(colliders, (*words)[0], (*words)[1]) || (*words)[2] > 1) return false;
    Recovery recovery{static_cast<int>((*words)[0]), static_cast<int>((*words)[1]), (*words)[2] != 0, Pose()};
    reader->numbers(recovery.X_AB.matrix().data(), NUMBERS);
    if (!isRigid(recovery.X_AB)) return false;
    recoveries->push_back(recovery);
  }
  return areSorted(*recoveries);
}

std::vector<std::uint64_t> ContactStage::forgetCollider(int collider) {
  std::vector<std::uint64_t> ids;
  for (const ReductionMemory* memory : {&std::as_const(memory_), &stops_.memory()}) {
    for (const ReductionMemory::Choice& choice : memory->choices()) {
      if (choice.a != collider && choice.b != collider) continue;
      for (const std::uint64_t id : choice.ids) {
        const std::uint64_t known_as = contactId(choice.a, choice.b, id);
        ids.push_back(memory == &memory_ ? known_as : stopId(known_as));
      }
    }
  }
  memory_.forget(collider);
  stops_.forget(collider);
  searches_.forget(collider);
  removePairsOf(collider, &current_search_.recoveries);
  arms_.clear();
  known_ = false;
  return ids;
}

int ContactStage::rawContacts() const { return countContacts(current_); }
int ContactStage::reducedContacts() const { return countContacts(reduced_); }

/** @param all contacts of the pair, of which the manifold's were kept */
void ContactStage::addConstraints(const SimulatedWorld& world, const ContactManifold& all, ContactManifold& manifold) {
  const Collider &a = world.colliders[manifold.a], &b = world.colliders[manifold.b];
  const SurfaceProperties surface = combineSurfaces(a.surface, b.surface, config_.friction_rule);
  if (std::isfinite(surface.stiffness) || std::isfinite(surface.damping)) weighSprings(manifold.contacts);
  const bool recovers = findPair(current_search_.recoveries, manifold.a, manifold.b) != nullptr;
  for (const Contact& contact : manifold.contacts) {
    ContactConstraint constraint = constraintOf(world, manifold, contact);
    constraint.friction = surface.friction;
    constraint.restitution = surface.restitution;
    constraint.impact_friction_factor = surface.impact_friction_factor;
    constraint.stiffness = contact.weight * surface.stiffness;
    constraint.damping = contact.weight * surface.damping;
    if (recovers && contact.depth > 0) separate(std::min(massOf(world, a), massOf(world, b)), manifold.layer, &constraint);
    constraints_.push_back(constraint);
    solved_.push_back({manifold.a, manifold.b, manifold.layer, contact.pierced, 0, recovers});
  }
  if (!recovers && isCompliant(surface)) addStops(world, all, surface.friction);
}

void ContactStage::addStops(const SimulatedWorld& world, const ContactManifold& all, double friction) {
  const double stop = LayerStops::STOP * all.layer;
  for (const Contact& contact : stops_.choose(all, *method_)) {
    ContactConstraint constraint = constraintOf(world, all, contact);
    constraint.friction = friction;
    constraint.id = stopId(constraint.id);
    constraints_.push_back(constraint);
    solved_.push_back({all.a, all.b, all.layer, false, stop, false});
  }
}

void ContactStage::reduction(const SimulatedWorld& world, const std::vector<BodyState>& bodies, double dt) {
  meetings_.look(world, bodies, *this, current_search_.flush, dt);
  meetings_.exchange(&current_);
  for (ContactManifold& manifold : reduced_) manifold.contacts.clear();  // one that has none any more keeps none
  model_a_.clear();
  model_b_.clear();
  for (const ContactManifold& manifold : current_) {
    model_a_.push_back(world.colliders[manifold.a].model);
    model_b_.push_back(world.colliders[manifold.b].model);
  }
  reduction_loss_ = reduceManifolds(current_, model_a_, model_b_, world.budgets, *method_, &memory_, &reduced_);
  constraints_.clear();
  solved_.clear();
  stops_.start();
  for (std::size_t m = 0; m < reduced_.size(); ++m) addConstraints(world, current_[m], reduced_[m]);
  stops_.remember();
  meetings_.exchange(&current_);
}

}  // namespace blem_sim
