#include "contacts/contact_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blem_sim/contact/collider_pairs.h"
#include "blem_sim/contact/narrow_phase.h"
#include "blem_sim/geometry/input_error.h"
#include "contacts/meeting_speed.h"

namespace blem_sim::sim {
namespace {

// Contacts exist before touch, so that none appears with a force: at rest within this of the layer, sooner at speed. Less between small
// things: contacts with everything around them would use up their budgets.
constexpr double BASE_MARGIN = 0.0005;         // [m], or
constexpr double BASE_MARGIN_OF_LENGTH = 0.1;  // of the shorter collider
// Contacts farther than this are not searched: before they come close, the step guard ends the substep.
constexpr double LEAST_MAX_MARGIN = 0.005;  // [m], or
constexpr double MAX_MARGIN_OF_LAYER = 2;   // layers
constexpr double UNGUARDED_MARGIN = 0.1;    // [m] where there is no layer, and over half-spaces: 66 m/s at 1 ms
// Forces may speed a body up during the step; a margin covers this times the present motion.
constexpr double REACH_FACTOR = 1.5;
constexpr double APART = 0.25;  // of the layer: a pair that crossed is sound again when its deepest contact uses up less

constexpr int MOST_AT_ONE_PLACE = 8;  // pairs of a collider with others at its place (leftOut()) that are looked at

/** Farthest corner of the geometry's box from the body's centre of mass. */
double armOf(const contact::Collider& collider, const Vector3& com) {
  if (!collider.geometry || collider.geometry->isHalfSpace()) return 0;
  const Box& box = collider.geometry->bounds();
  double arm = 0;
  for (int corner = 0; corner < 8; ++corner)
    arm = std::max(arm, (collider.X_BC * box.corner(static_cast<Box::CornerType>(corner)) - com).norm());
  return arm;
}

/** Length [m] of the longest edge of a collider's box, layers included. */
double extentOf(const contact::Collider& collider) {
  if (collider.geometry->isHalfSpace()) return std::numeric_limits<double>::infinity();
  return collider.geometry->bounds().sizes().maxCoeff() + 2 * collider.radius;
}

double baseMargin(const contact::Collider& a, const contact::Collider& b) {
  return std::min(BASE_MARGIN, BASE_MARGIN_OF_LENGTH * std::min(extentOf(a), extentOf(b)));
}

const reduction::Reduction* reductionNamed(const std::string& name) {
  const reduction::Reduction* method = reduction::findReduction(name);
  if (method) return method;
  std::string names;
  for (const reduction::Reduction& row : reduction::reductionTable()) names += (names.empty() ? "" : ", ") + std::string(row.name);
  throw InputError("contact.reduction: '" + name + "' is not known; take one of " + names);
}

}  // namespace

ContactStage::ContactStage(const ContactConfig& config, int threads)
    : config_(config), method_(reductionNamed(config.reduction)), searches_(threads) {}

void ContactStage::moveColliders(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                                 const std::vector<dynamics::BodyState>* faster, double dt) {
  const std::vector<contact::Collider>& colliders = world.colliders;
  for (std::size_t i = arms_.size(); i < colliders.size(); ++i) {
    const int body = colliders[i].body;
    arms_.push_back(body == dynamics::WORLD_BODY ? 0 : armOf(colliders[i], world.world.bodySpec(body).inertial.com));
  }
  const double fall = 0.5 * world.world.gravity().norm() * dt * dt;
  std::vector<contact::ColliderMotion>& motion = search_.motion;
  motion.resize(colliders.size());
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    if (colliders[i].body == dynamics::WORLD_BODY) {
      motion[i] = {colliders[i].X_BC, 0};
      continue;
    }
    const dynamics::BodyState& state = bodies[colliders[i].body];
    double speed = state.v_WCom.norm() + state.w_WB.norm() * arms_[i];
    if (faster) {
      const dynamics::BodyState& then = (*faster)[colliders[i].body];
      speed = std::max(speed, then.v_WCom.norm() + then.w_WB.norm() * arms_[i]);
    }
    motion[i] = {state.X_WB * colliders[i].X_BC, REACH_FACTOR * speed * dt + fall};
  }
}

/** WatchedPair::known: most [m] that two colliders can approach each other, moving on as they do, or if one of them is stopped dead. */
double ContactStage::knownMargin(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                                 const std::vector<dynamics::BodyState>* faster, const contact::ColliderPair& pair, double dt) const {
  const contact::Collider &a = world.colliders[pair.a], &b = world.colliders[pair.b];
  const double layer = a.radius + b.radius;
  const bool guarded = layer > 0 && !a.geometry->isHalfSpace() && !b.geometry->isHalfSpace();
  const double most = std::min(pair.margin, guarded ? std::max(LEAST_MAX_MARGIN, MAX_MARGIN_OF_LAYER * layer) : UNGUARDED_MARGIN);
  const double base = baseMargin(a, b);
  if (most <= base) return most;
  double speed = meetingSpeed(world, bodies, search_.motion, pair.a, pair.b, layer + pair.margin);
  if (faster) speed = std::max(speed, meetingSpeed(world, *faster, search_.motion, pair.a, pair.b, layer + pair.margin));
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

void ContactStage::broadPhase(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                              const std::vector<dynamics::BodyState>* faster, double dt) {
  moveColliders(world, bodies, faster, dt);
  search_.pairs.clear();
  search_.left_out.clear();
  at_one_place_.assign(world.colliders.size(), 0);
  for (const contact::ColliderPair& pair :
       pair_search_.find(world.colliders, search_.motion, world.filter, BASE_MARGIN, std::numeric_limits<double>::infinity())) {
    if (world.disabled_pairs.count({pair.a, pair.b}) > 0) continue;
    if (isAtOnePlace(world, pair.a, pair.b)) {
      if (at_one_place_[pair.a] >= MOST_AT_ONE_PLACE || at_one_place_[pair.b] >= MOST_AT_ONE_PLACE) {
        search_.left_out.push_back({pair.a, pair.b});
        continue;
      }
      ++at_one_place_[pair.a], ++at_one_place_[pair.b];
    }
    search_.pairs.push_back({pair.a, pair.b, pair.margin, knownMargin(world, bodies, faster, pair, dt)});
  }
}

Recovery ContactStage::lastApart(int a, int b) const {
  if (const Recovery* recovery = current_search_.crossings.find(a, b)) return *recovery;
  if (!known_ || contact::findPair(current_search_.left_out, a, b)) return {a, b, false, Pose::Identity()};
  return {a, b, true, current_search_.motion[a].X_WC.inverse() * current_search_.motion[b].X_WC};
}

void ContactStage::narrowPhase(const SimulatedWorld& world) {
  const std::size_t pairs = search_.pairs.size();
  for (; found_.size() < pairs && !spare_.empty(); spare_.pop_back()) found_.push_back(std::move(spare_.back()));
  if (found_.size() < pairs) found_.resize(pairs);
  search_.last_apart.clear();
  for (const WatchedPair& pair : search_.pairs) search_.last_apart.push_back(lastApart(pair.a, pair.b));
  search_.flush.watch(world.colliders, search_.pairs);
  searches_.run(search_.pairs, [&](std::size_t i, contact::NarrowPhaseMemory* memory) {
    const WatchedPair& pair = search_.pairs[i];
    const Recovery& last = search_.last_apart[i];
    blem_sim::contact::narrowPhase(world.colliders[pair.a], search_.motion[pair.a].X_WC, world.colliders[pair.b],
                                   search_.motion[pair.b].X_WC, pair.known, &found_[i], last.known ? &last.X_AB : nullptr, memory);
    found_[i].a = pair.a;
    found_[i].b = pair.b;
    search_.flush.dropCovered(world.colliders, search_.motion, &found_[i]);
    fading_.apply(&found_[i]);
  });
  keepWhatWasFound(pairs);
}

/** Keeps the manifolds with contacts, and the pairs that cross or are not apart yet. */
void ContactStage::keepWhatWasFound(std::size_t pairs) {
  search_.crossings.clear();
  std::size_t manifolds = 0;
  for (std::size_t i = 0; i < pairs; ++i) {
    const contact::ContactManifold& manifold = found_[i];
    const bool was_recovering = current_search_.crossings.find(manifold.a, manifold.b) != nullptr;
    if (manifold.pierced || (was_recovering && manifold.maxDepth() > APART * manifold.layer)) search_.crossings.add(search_.last_apart[i]);
    if (manifold.contacts.empty()) continue;
    if (manifolds != i) std::swap(found_[manifolds], found_[i]);
    ++manifolds;
  }
  for (; found_.size() > manifolds; found_.pop_back()) spare_.push_back(std::move(found_.back()));
}

void ContactStage::accept() {
  std::swap(current_, found_);
  std::swap(current_search_, search_);
  known_ = true;
}

}  // namespace blem_sim::sim
