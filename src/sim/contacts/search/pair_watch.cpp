#include "contacts/search/pair_watch.h"

#include <algorithm>
#include <limits>

#include "contacts/motion/body_twist.h"
#include "contacts/motion/meeting_speed.h"

namespace blem_sim::sim {
namespace {

// Contacts exist before touch, so that none appears with a force: at rest within this of the layer, sooner at speed. Less between small
// things: contacts with everything around them would use up their budgets.
constexpr double BASE_MARGIN = 0.0005;         // [m], or
constexpr double BASE_MARGIN_OF_LENGTH = 0.1;  // of the shorter collider
// Contacts farther than this are not searched: before they come close, the step guard ends the substep.
// Beyond their own length, small things see each other whole: contacts of all their features.
constexpr double LEAST_MAX_MARGIN = 0.005;  // [m], at most the length of the shorter collider, or
constexpr double MAX_MARGIN_OF_LAYER = 2;   // layers
constexpr double UNGUARDED_MARGIN = 0.1;    // [m] where there is no layer, and over half-spaces: 66 m/s at 1 ms
// Forces may speed a body up during the step; a margin covers this times the present motion.
constexpr double REACH_FACTOR = 1.5;

constexpr int MOST_AT_ONE_PLACE = 8;  // pairs of a collider with others at its place (WatchedPairs::left_out) that are looked at

/** Farthest corner of the geometry's box from the body's centre of mass. */
double armOf(const contact::Collider& collider, const Vector3& com) {
  if (!collider.geometry || collider.geometry->isHalfSpace()) return 0;
  const Box& box = collider.geometry->bounds();
  double arm = 0;
  for (int corner = 0; corner < 8; ++corner)
    arm = std::max(arm, (collider.X_BC * box.corner(static_cast<Box::CornerType>(corner)) - com).norm());
  return arm;
}

/** [m/s] Speed of a collider's surface, at most: spin of a cylinder about its axis leaves it where it is. @param arm of the collider [m] */
double surfaceSpeed(const contact::Collider& collider, const Pose& X_WC, const BodyTwist& twist, double arm) {
  const double speed = twist.v.norm() + twist.w.norm() * arm;
  if (!collider.geometry || !collider.geometry->cylinder()) return speed;
  const BodyTwist seen = surfaceTwist(collider, X_WC, twist);
  return std::min(speed, seen.v.norm() + seen.w.norm() * 0.5 * collider.geometry->bounds().diagonal().norm());
}

/** Length [m] of the longest edge of a collider's box, layers included. */
double extentOf(const contact::Collider& collider) {
  if (collider.geometry->isHalfSpace()) return std::numeric_limits<double>::infinity();
  return collider.geometry->bounds().sizes().maxCoeff() + 2 * collider.radius;
}

/** Length [m] of the shorter collider. */
double shorterLength(const contact::Collider& a, const contact::Collider& b) { return std::min(extentOf(a), extentOf(b)); }

double baseMargin(const contact::Collider& a, const contact::Collider& b) {
  return std::min(BASE_MARGIN, BASE_MARGIN_OF_LENGTH * shorterLength(a, b));
}

/** Largest margin [m] where a step guard ends the substep. */
double guardedMargin(const contact::Collider& a, const contact::Collider& b, double layer) {
  return std::max(std::min(LEAST_MAX_MARGIN, shorterLength(a, b)), MAX_MARGIN_OF_LAYER * layer);
}

/** WatchedPair::known: most [m] that two colliders can approach each other, moving on as they do, or if one of them is stopped dead. */
double knownMargin(const StateAhead& ahead, const std::vector<contact::ColliderMotion>& motion, const contact::ColliderPair& pair) {
  const contact::Collider &a = ahead.world.colliders[pair.a], &b = ahead.world.colliders[pair.b];
  const double layer = a.radius + b.radius;
  const bool guarded = layer > 0 && !a.geometry->isHalfSpace() && !b.geometry->isHalfSpace();
  const double most = std::min(pair.margin, guarded ? guardedMargin(a, b, layer) : UNGUARDED_MARGIN);
  const double base = baseMargin(a, b);
  if (most <= base) return most;
  const double alone = std::max(motion[pair.a].reach, motion[pair.b].reach) / REACH_FACTOR, least = std::max(alone, base);
  const auto reachAt = [&](const std::vector<dynamics::BodyState>& bodies) {
    const double bound = REACH_FACTOR * ahead.dt * meetingSpeedBound(ahead.world, bodies, motion, pair);
    return bound <= least ? 0 : REACH_FACTOR * meetingSpeed(ahead.world, bodies, motion, pair) * ahead.dt;
  };
  const double reach = std::max(reachAt(ahead.bodies), ahead.faster ? reachAt(*ahead.faster) : 0);
  return std::clamp(std::max(reach, alone), base, most);
}

bool isAtOnePlace(const std::vector<contact::Collider>& colliders, const std::vector<contact::ColliderMotion>& motion, int a, int b) {
  const auto boxOf = [&](int collider) -> const Box& { return colliders[collider].geometry->bounds(); };
  for (const int collider : {a, b})
    if (!colliders[collider].geometry || colliders[collider].geometry->isHalfSpace()) return false;
  const Vector3 middle_a = motion[a].X_WC * boxOf(a).center(), middle_b = motion[b].X_WC * boxOf(b).center();
  const double smaller = std::min(boxOf(a).diagonal().squaredNorm(), boxOf(b).diagonal().squaredNorm());
  if ((middle_a - middle_b).squaredNorm() > 0.25 * smaller) return false;
  return boxOf(a).contains(motion[a].X_WC.inverse() * middle_b) && boxOf(b).contains(motion[b].X_WC.inverse() * middle_a);
}

}  // namespace

void PairWatch::measureArms(const SimulatedWorld& world) {
  for (std::size_t i = arms_.size(); i < world.colliders.size(); ++i) {
    const int body = world.colliders[i].body;
    arms_.push_back(body == dynamics::WORLD_BODY ? 0 : armOf(world.colliders[i], world.world.bodySpec(body).inertial.com));
  }
}

void PairWatch::moveColliders(const StateAhead& ahead, std::vector<contact::ColliderMotion>* motion) {
  const std::vector<contact::Collider>& colliders = ahead.world.colliders;
  const double fall = 0.5 * ahead.world.world.gravity().norm() * ahead.dt * ahead.dt;
  const auto speed_of = [&](const std::vector<dynamics::BodyState>& bodies, std::size_t i) {
    return surfaceSpeed(colliders[i], (*motion)[i].X_WC, twistOf(ahead.world, bodies, colliders[i].body), arms_[i]);
  };
  motion->resize(colliders.size());
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    const int body = colliders[i].body;
    if (body == dynamics::WORLD_BODY) {
      (*motion)[i] = {colliders[i].X_BC, 0};
      continue;
    }
    (*motion)[i].X_WC = ahead.bodies[body].X_WB * colliders[i].X_BC;
    double speed = speed_of(ahead.bodies, i);
    if (ahead.faster) speed = std::max(speed, speed_of(*ahead.faster, i));
    (*motion)[i].reach = REACH_FACTOR * speed * ahead.dt + fall;
  }
}

/** Whether a pair is at one place, and either collider has enough such pairs already. */
bool PairWatch::isOneTooMany(const SimulatedWorld& world, const std::vector<contact::ColliderMotion>& motion,
                             const contact::ColliderPair& pair) {
  if (!isAtOnePlace(world.colliders, motion, pair.a, pair.b)) return false;
  if (at_one_place_[pair.a] >= MOST_AT_ONE_PLACE || at_one_place_[pair.b] >= MOST_AT_ONE_PLACE) return true;
  ++at_one_place_[pair.a], ++at_one_place_[pair.b];
  return false;
}

void PairWatch::find(const StateAhead& ahead, WatchedPairs* watched) {
  const SimulatedWorld& world = ahead.world;
  measureArms(world);
  moveColliders(ahead, &watched->motion);
  watched->pairs.clear();
  watched->left_out.clear();
  at_one_place_.assign(world.colliders.size(), 0);
  const auto* near = threads_->with([&] {
    return &broad_phase_.find(world.colliders, watched->motion, world.filter, BASE_MARGIN, std::numeric_limits<double>::infinity());
  });
  for (const contact::ColliderPair& pair : *near) {
    if (world.disabled_pairs.count({pair.a, pair.b}) > 0) continue;
    if (isOneTooMany(world, watched->motion, pair))
      watched->left_out.push_back({pair.a, pair.b});
    else
      watched->pairs.push_back({pair, 0});
  }
  threads_->forAll(watched->pairs.size(), PAIRS_AT_ONCE,
                   [&](std::size_t i, std::size_t) { watched->pairs[i].known = knownMargin(ahead, watched->motion, watched->pairs[i]); });
}

}  // namespace blem_sim::sim
