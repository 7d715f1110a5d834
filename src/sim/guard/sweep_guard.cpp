#include "guard/sweep_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blem_sim/contact/collider_pairs.h"

namespace blem_sim::sim {
namespace {

constexpr double STILL = 1e-3;         // of the layer: less motion uses up nothing
constexpr double HALF = 0.5;           // of the layer
constexpr double TURN_OF_CHORD = 1.2;  // [rad] of a turn by at most pi, over the Frobenius norm of its change of axes: pi / (2 sqrt 2)

constexpr double BENT = 0.02;  // of the layer: a way that bends less is straight

/** Turn [rad] between two poses, at least. */
double turnAtMost(const Pose& from, const Pose& to) { return TURN_OF_CHORD * (to.linear() - from.linear()).norm(); }

/** Way of a cylinder's surface, which spin about its axis leaves where it is, about its middle. */
contact::GeometrySweep wayOfCylinder(const contact::Collider& collider, const Pose& from, const Pose& to) {
  const Pose X_BK = collider.X_BC * collider.geometry->cylinder()->X_GK, before = from * X_BK, after = to * X_BK;
  const Eigen::AngleAxisd turn(Quaternion::FromTwoVectors(before.linear().col(2), after.linear().col(2)));
  contact::GeometrySweep sweep;
  sweep.centre = before.translation();
  sweep.shift = after.translation() - before.translation();
  sweep.turn = turn.angle() * turn.axis();
  return sweep;
}

bool isCylinder(const contact::Collider& collider) { return collider.geometry && collider.geometry->cylinder(); }

bool hasArea(const contact::CollisionGeometry& geometry) { return geometry.mesh().isTriangle(0); }

bool canPass(const contact::Collider& a, const contact::Collider& b) {
  return a.radius + b.radius > 0 && !a.geometry->isHalfSpace() && !b.geometry->isHalfSpace();
}

}  // namespace

const std::vector<ClosePass>& SweepGuard::look(const SimulatedWorld& world, const MadeSolve& made, const std::vector<double>& arms,
                                               const FadingPoints& fading) {
  close_.clear();
  before_ = &made.before;
  after_ = &made.after;
  moveColliders(world, made, arms);
  const std::vector<WatchedPair>& pairs = made.start.watched.pairs;
  nearness_.resize(pairs.size());
  threads_->forAll(pairs.size(), PAIRS_AT_ONCE,
                   [&](std::size_t i, std::size_t) { nearness_[i] = nearnessOf(world, made, fading, pairs[i]); });
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (std::isfinite(nearness_[i].distance)) lookAt(world, pairs[i].a, pairs[i].b, nearness_[i]);
  if (leavesWhatWasSearched(world, made.start.watched)) lookAtOthers(world, made.start.watched);
  return close_;
}

SweepGuard::Nearness SweepGuard::nearnessOf(const SimulatedWorld& world, const MadeSolve& made, const FadingPoints& fading,
                                            const WatchedPair& pair) const {
  constexpr Nearness NOT_NEAR{std::numeric_limits<double>::infinity(), false};
  const contact::Collider &a = world.colliders[pair.a], &b = world.colliders[pair.b];
  const double layer = a.radius + b.radius, motion = motion_[pair.a].reach + motion_[pair.b].reach;
  if (motion <= STILL * layer || !canPass(a, b) || fading.crosses(pair.a, pair.b)) return NOT_NEAR;
  const contact::ContactManifold* known = contact::findPair(made.start.manifolds, pair.a, pair.b);
  if (known && known->pierced) return NOT_NEAR;
  const double distance = layer - (known ? made.start.depthOf(*known) : -pair.known);
  const bool near = distance - motion < (known ? SPARED : HALF) * layer && !made.start.crossings.find(pair.a, pair.b);
  return near ? Nearness{distance, known != nullptr} : NOT_NEAR;
}

void SweepGuard::moveColliders(const SimulatedWorld& world, const MadeSolve& made, const std::vector<double>& arms) {
  motion_.resize(world.colliders.size());
  for (std::size_t i = 0; i < motion_.size(); ++i) {
    const int body = world.colliders[i].body;
    motion_[i] = {made.start.watched.motion[i].X_WC, 0};
    if (body == dynamics::WORLD_BODY) continue;
    const Vector3& com = world.world.bodySpec(body).inertial.com;
    const Pose &from = made.before[body].X_WB, &to = made.after[body].X_WB;
    motion_[i].reach = (to * com - from * com).norm() + turnAtMost(from, to) * arms[i];
    if (!isCylinder(world.colliders[i])) continue;
    const contact::GeometrySweep way = wayOfCylinder(world.colliders[i], from, to);
    const double arm = 0.5 * world.colliders[i].geometry->bounds().diagonal().norm() + world.colliders[i].radius;
    motion_[i].reach = std::min(motion_[i].reach, way.shift.norm() + way.turn.norm() * arm);
  }
  bendWays(world, made.before, made.after);
}

/** The middle of a link that turns with its robot's links moves on an arc, whose height over its chord adds to the way. */
void SweepGuard::bendWays(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& before,
                          const std::vector<dynamics::BodyState>& after) {
  bends_.assign(world.colliders.size(), 0);
  turns_.assign(world.models.size(), 0);
  for (std::size_t m = 0; m < turns_.size(); ++m)
    if (world.models[m].alive && world.models[m].kind == ModelKind::ROBOT)
      for (const int body : world.models[m].bodies)
        if (body != dynamics::WORLD_BODY) turns_[m] = std::max(turns_[m], std::min(M_PI, turnAtMost(before[body].X_WB, after[body].X_WB)));
  for (std::size_t i = 0; i < bends_.size(); ++i) {
    const contact::Collider& collider = world.colliders[i];
    if (collider.body == dynamics::WORLD_BODY || turns_[collider.model] == 0) continue;
    const Vector3& com = world.world.bodySpec(collider.body).inertial.com;
    const double chord = (after[collider.body].X_WB * com - before[collider.body].X_WB * com).norm();
    const double height = 0.5 * chord * std::tan(0.25 * turns_[collider.model]);
    if (height < BENT * collider.radius) continue;
    bends_[i] = height;
    motion_[i].reach += height;
  }
}

contact::GeometrySweep SweepGuard::sweepOf(const SimulatedWorld& world, int collider) const {
  contact::GeometrySweep sweep;
  const int body = world.colliders[collider].body;
  if (body != dynamics::WORLD_BODY && isCylinder(world.colliders[collider]))
    sweep = wayOfCylinder(world.colliders[collider], (*before_)[body].X_WB, (*after_)[body].X_WB);
  sweep.X_WC = motion_[collider].X_WC;
  if (body == dynamics::WORLD_BODY || isCylinder(world.colliders[collider])) return sweep;
  const Vector3& com = world.world.bodySpec(body).inertial.com;
  const Pose &from = (*before_)[body].X_WB, &to = (*after_)[body].X_WB;
  sweep.centre = from * com;
  sweep.shift = to * com - sweep.centre;
  sweep.turn = contact::turnBetween(from, to);
  return sweep;
}

// Whether a collider used up its layer and margin: a pair that is not searched is farther apart than both colliders' together.
bool SweepGuard::leavesWhatWasSearched(const SimulatedWorld& world, const WatchedPairs& watched) const {
  for (std::size_t i = 0; i < motion_.size(); ++i) {
    const contact::Collider& collider = world.colliders[i];
    if (collider.enabled && motion_[i].reach > (1 - HALF) * collider.radius + watched.motion[i].reach) return true;
  }
  return false;
}

void SweepGuard::lookAtOthers(const SimulatedWorld& world, const WatchedPairs& watched) {
  const std::size_t of_watched = close_.size();
  const double any = std::numeric_limits<double>::infinity();
  const auto* others = threads_->with([&] { return &other_pairs_.find(world.colliders, motion_, world.filter, 0, any); });
  for (const contact::ColliderPair& pair : *others) {
    const contact::Collider &a = world.colliders[pair.a], &b = world.colliders[pair.b];
    if (!canPass(a, b) || world.disabled_pairs.count({pair.a, pair.b}) > 0 || contact::findPair(watched.pairs, pair.a, pair.b)) continue;
    lookAt(world, pair.a, pair.b, {a.radius + b.radius, false});
  }
  std::inplace_merge(close_.begin(), close_.begin() + static_cast<std::ptrdiff_t>(of_watched), close_.end(), contact::IsPairBefore());
}

void SweepGuard::lookAt(const SimulatedWorld& world, int a, int b, const Nearness& nearness) {
  const double distance = nearness.distance;
  const contact::CollisionGeometry &geometry_a = *world.colliders[a].geometry, &geometry_b = *world.colliders[b].geometry;
  const double layer = world.colliders[a].radius + world.colliders[b].radius;
  if (!(distance > 0)) return;
  const bool cross = nearness.known || hasArea(geometry_a) || hasArea(geometry_b);
  const double bend = bends_[a] + bends_[b];
  const auto left = [&](double share) { return std::min(share * layer, 0.5 * distance) + bend; };
  const double spared = left(cross ? SPARED : HALF);
  const contact::GeometrySweep sweep_a = sweepOf(world, a), sweep_b = sweepOf(world, b);
  const double most = contact::mostApproach(geometry_a, sweep_a, geometry_b, sweep_b) + bend;
  if (distance - most >= spared - bend || !contact::mayComeWithin(spared, geometry_a, sweep_a, geometry_b, sweep_b)) return;
  const bool passed = !cross || contact::mayComeWithin(left(NOTHING), geometry_a, sweep_a, geometry_b, sweep_b);
  close_.push_back({a, b, std::min(1.0, std::max(distance - layer, HALF * layer) / most), passed});
}

}  // namespace blem_sim::sim
