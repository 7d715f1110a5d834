#include "guard/step_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blem_sim/contact/collider_pairs.h"

namespace blem_sim::sim {
namespace {

constexpr double USED_UP = 0.9;       // of the layer
constexpr double LEAST_GROWTH = 0.1;  // of the layer in one step: slower sinking is not for the guard
constexpr double LEAP = 0.2;    // of the layer in one step: deeper, the solve did not know of the contact, or springs take shorter steps
constexpr double ROOM = 1.3;    // times a longer part: links in tension can take it, and go on to
constexpr double BEYOND = 0.2;  // [m] at most, that a contact is outside the boxes of both colliders, to both sides together

/** Used-up share of the layer; 0 without contact. @param of contacts of a state @param manifold one of theirs */
double used(const FoundContacts& of, const contact::ContactManifold& manifold) {
  return std::max(0.0, of.depthOf(manifold) / manifold.layer);
}

bool inDanger(double before, double after) { return after > USED_UP && after - before > LEAST_GROWTH; }

/** Motion of points fixed on the body: from their place in the world before to that after. */
Pose motionBetween(int body, const std::vector<dynamics::BodyState>& before, const std::vector<dynamics::BodyState>& after) {
  return body == dynamics::WORLD_BODY ? Pose::Identity() : after[body].X_WB * before[body].X_WB.inverse();
}

/** [m] Largest extent of the contacts of two colliders; infinite if nothing bounds it. */
double extent(const contact::Collider& a, const contact::Collider& b) {
  double least = std::numeric_limits<double>::infinity();
  for (const contact::Collider* collider : {&a, &b})
    if (collider->geometry && !collider->geometry->isHalfSpace()) least = std::min(least, collider->geometry->bounds().diagonal().norm());
  return least + 2 * (a.radius + b.radius) + BEYOND;
}

/** Bound on `carried`: no contact was carried deeper, of the layer. @param size [m] extent of the contacts */
double mostCarried(const contact::ContactManifold& manifold, double depth, double size, const Pose& motion_a, const Pose& motion_b) {
  const Vector3& somewhere = manifold.contacts.front().point;
  const double motion = (motion_a * somewhere - motion_b * somewhere).norm() + (motion_a.linear() - motion_b.linear()).norm() * size;
  return (depth + motion) / manifold.layer;
}

/** Deepest that a contact of the manifold was carried, of the layer. */
double carried(const contact::ContactManifold& manifold, const Pose& motion_a, const Pose& motion_b) {
  double deepest = 0;
  for (const contact::Contact& contact : manifold.contacts) {
    const double parted = contact.normal_BA.dot(motion_a * contact.point - motion_b * contact.point);
    deepest = std::max(deepest, (contact.depth - parted) / manifold.layer);
  }
  return deepest;
}

/** @param now of the contacts after the step */
bool isTooDeep(const contact::ContactManifold& now, const FoundContacts& before, const FoundContacts& after) {
  if (!(now.layer > 0)) return false;
  const double used_now = used(after, now);
  if (!now.pierced && used_now <= LEAP) return false;
  const contact::ContactManifold* then = contact::findPair(before.manifolds, now.a, now.b);
  if (now.pierced && !(then && then->pierced)) return true;
  const double used_then = then ? used(before, *then) : 0;
  return inDanger(used_then, used_now) || used_now - used_then > LEAP;
}

/** @param then of the contacts before the step */
bool isCarriedTooFar(const contact::ContactManifold& then, const std::vector<contact::Collider>& colliders, const MadeSolve& made) {
  if (!(then.layer > 0) || then.pierced || then.contacts.empty()) return false;
  const contact::Collider &a = colliders[then.a], &b = colliders[then.b];
  const Pose motion_a = motionBetween(a.body, made.before, made.after), motion_b = motionBetween(b.body, made.before, made.after);
  if (mostCarried(then, made.start.depthOf(then), extent(a, b), motion_a, motion_b) <= USED_UP) return false;
  return inDanger(used(made.start, then), carried(then, motion_a, motion_b));
}

}  // namespace

bool usesUpLayer(const std::vector<contact::Collider>& colliders, const MadeSolve& made, const FoundContacts& after, StepThreads* threads) {
  const std::vector<contact::ContactManifold>&before = made.start.manifolds, &now = after.manifolds;
  return threads->anyOf(now.size(), PAIRS_AT_ONCE, [&](std::size_t m) { return isTooDeep(now[m], made.start, after); }) ||
         threads->anyOf(before.size(), PAIRS_AT_ONCE, [&](std::size_t m) { return isCarriedTooFar(before[m], colliders, made); });
}

void Substeps::plan(double part) {
  const int left = MAX_SUBSTEPS - done_;
  size_ = std::clamp(static_cast<int>(std::floor(part * left)), 1, std::min(left, most_));
}

void Substeps::bound(double part) {
  const double ticks = part * MAX_SUBSTEPS;
  longest_ = std::min(longest_, ticks);
  while (most_ > 1 && size_ > ticks && most_ > ticks) most_ /= 2;
}

int Substeps::nextMost() const { return longest_ < ROOM * 2 * most_ ? most_ : std::min(2 * most_, MAX_SUBSTEPS); }

void Substeps::redo(double part) {
  size_ = std::clamp(static_cast<int>(std::floor(part * size_)), 1, std::clamp(size_ / 2, 1, most_));
  ++redone_;
  redone_at_hand_ = true;
  repeated_at_hand_ = false;
}

void Substeps::repeat() {
  ++repeated_;
  repeated_at_hand_ = true;
}

void Substeps::accept() {
  done_ += size_;
  ++count_;
  size_ = std::min(size_, MAX_SUBSTEPS - done_);
  redone_at_hand_ = repeated_at_hand_ = false;
}

}  // namespace blem_sim::sim
