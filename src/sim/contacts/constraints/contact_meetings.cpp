#include "contacts/constraints/contact_meetings.h"

#include <algorithm>
#include <iterator>

#include "blem_sim/contact/collider_pairs.h"

namespace blem_sim::sim {
namespace {

constexpr double BEARING_GAP = 1e-6;  // [m] largest gap of a contact that bears a body

/** Largest change [m/s] of a contact's velocity from that at hand to that of the pair's way. The solve begins with the slip at hand: where
 * the gap spares less than friction makes of that change, contacts that are not met would push. */
double changeOf(const SolveAhead& ahead, const WayOfPair& way) {
  const auto atHand = [&](const ColliderWay& of) {
    return surfaceTwist(*of.collider, of.X_WC, twistOf(ahead.world, ahead.bodies, of.collider->body));
  };
  const BodyTwist a = atHand(way.a), b = atHand(way.b);
  double largest = 0;
  for (const contact::Contact& contact : way.now.contacts) {
    const Vector3& p = contact.point;
    largest = std::max(largest, (way.a.twist.at(p) - way.b.twist.at(p) - a.at(p) + b.at(p)).norm());
  }
  return largest;
}

bool falls(const ModelInfo& model) { return model.kind == ModelKind::OBJECT && model.weightless.empty(); }

}  // namespace

void ContactMeetings::findSupports(const SimulatedWorld& world, const FoundContacts& contacts) {
  supports_.assign(world.world.bodyCount(), Support());
  for (const contact::ContactManifold& manifold : contacts.manifolds) {
    const double depth = contacts.depthOf(manifold);
    if (depth < -BEARING_GAP) continue;
    for (const int collider : {manifold.a, manifold.b}) {
      const int body = world.colliders[collider].body;
      if (body == dynamics::WORLD_BODY) continue;
      supports_[body].touches = true;
      supports_[body].depth = std::max(supports_[body].depth, depth);
    }
  }
}

double ContactMeetings::depthOf(const SimulatedWorld& world, int collider) const {
  const int body = world.colliders[collider].body;
  return body == dynamics::WORLD_BODY ? 0 : supports_[body].depth;
}

/** Way of a collider. An object that touches nothing falls; other bodies are borne by their contacts or motors. */
ColliderWay ContactMeetings::wayOf(const SolveAhead& ahead, int collider) const {
  const SimulatedWorld& world = ahead.world;
  const contact::Collider& c = world.colliders[collider];
  const BodyTwist now = twistOf(world, ahead.bodies, c.body);
  ColliderWay way{&c, ahead.contacts.watched.motion[collider].X_WC, now.centre, now};
  if (c.body != dynamics::WORLD_BODY && falls(world.models[c.model]) && !supports_[c.body].touches)
    way.twist.v += ahead.dt * world.world.gravity();
  way.twist = surfaceTwist(c, way.X_WC, way.twist);
  return way;
}

/** Way of a collider to where it is expected at the end of the solve. */
ColliderWay ContactMeetings::expectedWayOf(const SolveAhead& ahead, int collider) const {
  const contact::Collider& c = ahead.world.colliders[collider];
  const BodyTwist now = twistOf(ahead.world, ahead.bodies, c.body);
  ColliderWay way{&c, ahead.contacts.watched.motion[collider].X_WC, now.centre, now};
  if (c.body == dynamics::WORLD_BODY) return way;
  const dynamics::BodyState& then = ahead.expected.bodies[c.body];
  way.twist = {now.centre, then.v_WCom, then.w_WB};
  ways_.leadTo(c.body, then.X_WB, &way.twist);
  way.twist = surfaceTwist(c, way.X_WC, way.twist);
  return way;
}

/** Contacts of a manifold to be solved instead; they count once replaced_count_ does. */
std::vector<contact::Contact>* ContactMeetings::room(std::size_t manifold) {
  if (replaced_.size() == replaced_count_) replaced_.emplace_back();
  replaced_[replaced_count_].manifold = manifold;
  return &replaced_[replaced_count_].contacts;
}

/** @param way of the pair until the end of the solve */
void ContactMeetings::follow(const SolveAhead& ahead, std::size_t manifold, WayOfPair* way) {
  const int a = way->now.a, b = way->now.b;
  const FoundContacts& contacts = ahead.contacts;
  way->dt = ahead.dt;
  way->fading = &ahead.fading;
  way->workspace = ahead.workspace;
  way->known = contact::findPair(contacts.watched.pairs, a, b)->known;
  way->depth = std::max(depthOf(ahead.world, a), depthOf(ahead.world, b));
  if (way_.follow(*way, contacts.flush, ahead.world.colliders, contacts.watched.motion, room(manifold))) ++replaced_count_;
}

WayOfPair ContactMeetings::wayOfPair(const SolveAhead& ahead, const contact::ContactManifold& now) const {
  WayOfPair way{ahead.world, now, wayOf(ahead, now.a), wayOf(ahead, now.b)};
  way.dt = ahead.dt;
  way.swing = ways_.swing(way.a.collider->body) + ways_.swing(way.b.collider->body);
  return way;
}

bool ContactMeetings::isDoubtful(const SolveAhead& ahead, const contact::ContactManifold& now) const {
  const contact::Collider &a = ahead.world.colliders[now.a], &b = ahead.world.colliders[now.b];
  if (a.geometry->isHalfSpace() || b.geometry->isHalfSpace()) return false;
  return !now.pierced && !ahead.contacts.crossings.find(now.a, now.b) && way_.isDoubtful(wayOfPair(ahead, now));
}

void ContactMeetings::lookAt(const SolveAhead& ahead, std::size_t manifold) {
  WayOfPair way = wayOfPair(ahead, ahead.contacts.manifolds[manifold]);
  for (ColliderWay* of : {&way.a, &way.b}) {
    ways_.lead(of->collider->body, &of->twist);
    of->twist = surfaceTwist(*of->collider, of->X_WC, of->twist);
  }
  follow(ahead, manifold, &way);
}

void ContactMeetings::keepWhatBears(const SolveAhead& ahead, std::size_t manifold) {
  const contact::ContactManifold& now = ahead.contacts.manifolds[manifold];
  std::vector<contact::Contact>* kept = room(manifold);
  kept->clear();
  std::copy_if(now.contacts.begin(), now.contacts.end(), std::back_inserter(*kept),
               [&](const contact::Contact& contact) { return bears(ahead.world, now, contact); });
  ++replaced_count_;
}

void ContactMeetings::lookAgain(const SolveAhead& ahead, std::size_t manifold) {
  if (ahead.expected.bodies.empty()) return keepWhatBears(ahead, manifold);
  const contact::ContactManifold& now = ahead.contacts.manifolds[manifold];
  WayOfPair way{ahead.world, now, expectedWayOf(ahead, now.a), expectedWayOf(ahead, now.b)};
  way.swing = changeOf(ahead, way);
  follow(ahead, manifold, &way);
}

void ContactMeetings::look(const SolveAhead& ahead) {
  const std::vector<contact::ContactManifold>& manifolds = ahead.contacts.manifolds;
  replaced_count_ = 0;
  ways_.start(ahead.world, ahead.bodies, ahead.dt);
  findSupports(ahead.world, ahead.contacts);
  is_doubtful_.resize(manifolds.size());
  threads_->forAll(manifolds.size(), PAIRS_AT_ONCE, [&](std::size_t m, std::size_t) { is_doubtful_[m] = isDoubtful(ahead, manifolds[m]); });
  for (std::size_t m = 0; m < manifolds.size(); ++m) {
    if (contact::findPair(ahead.expected.pairs, manifolds[m].a, manifolds[m].b))
      lookAgain(ahead, m);
    else if (is_doubtful_[m])
      lookAt(ahead, m);
  }
}

void ContactMeetings::exchange(std::vector<contact::ContactManifold>* manifolds) {
  for (std::size_t i = 0; i < replaced_count_; ++i) std::swap((*manifolds)[replaced_[i].manifold].contacts, replaced_[i].contacts);
}

}  // namespace blem_sim::sim
