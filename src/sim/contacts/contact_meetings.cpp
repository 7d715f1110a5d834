#include "contacts/contact_meetings.h"

#include <algorithm>
#include <iterator>

#include "blem_sim/contact/collider_pairs.h"
#include "contacts/contact_stage.h"

namespace blem_sim::sim {
namespace {

constexpr double BEARING_GAP = 1e-6;  // [m] largest gap of a contact that bears a body

/** Largest change [m/s] of a contact's velocity from that at hand to that of the pair's way. The solve begins with the slip at hand: where
 * the gap spares less than friction makes of that change, contacts that are not met would push. */
double changeOf(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, const WayOfPair& way) {
  const BodyTwist a = twistOf(world, bodies, way.a.collider->body), b = twistOf(world, bodies, way.b.collider->body);
  double largest = 0;
  for (const contact::Contact& contact : way.now.contacts) {
    const Vector3& p = contact.point;
    largest = std::max(largest, (way.a.twist.at(p) - way.b.twist.at(p) - a.at(p) + b.at(p)).norm());
  }
  return largest;
}

}  // namespace

void ContactMeetings::findSupports(const SimulatedWorld& world, const std::vector<contact::ContactManifold>& manifolds) {
  supports_.assign(world.world.bodyCount(), Support());
  for (const contact::ContactManifold& manifold : manifolds) {
    const double depth = manifold.maxDepth();
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
ColliderWay ContactMeetings::wayOf(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies,
                                   const ContactStage& contacts, int collider, double dt) const {
  const contact::Collider& c = world.colliders[collider];
  const BodyTwist now = twistOf(world, bodies, c.body);
  ColliderWay way{&c, contacts.motion()[collider].X_WC, now.centre, now};
  if (c.body != dynamics::WORLD_BODY && world.models[c.model].kind == ModelKind::OBJECT && !supports_[c.body].touches)
    way.twist.v += dt * world.world.gravity();
  return way;
}

/** Contacts of a manifold to be solved instead; they count once replaced_count_ does. */
std::vector<contact::Contact>* ContactMeetings::room(std::size_t manifold) {
  if (replaced_.size() == replaced_count_) replaced_.emplace_back();
  replaced_[replaced_count_].manifold = manifold;
  return &replaced_[replaced_count_].contacts;
}

/** @param way of the pair until the end of the solve */
void ContactMeetings::follow(const SimulatedWorld& world, const ContactStage& contacts, const FlushSurfaces& flush, std::size_t manifold,
                             WayOfPair* way) {
  const int a = way->now.a, b = way->now.b;
  way->fading = &contacts.fading();
  way->known = contact::findPair(contacts.watched(), a, b)->known;
  way->depth = std::max(depthOf(world, a), depthOf(world, b));
  if (way_.follow(*way, flush, world.colliders, contacts.motion(), room(manifold))) ++replaced_count_;
}

void ContactMeetings::lookAt(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, const ContactStage& contacts,
                             const FlushSurfaces& flush, std::size_t manifold, double dt) {
  const contact::ContactManifold& now = contacts.current()[manifold];
  const contact::Collider &a = world.colliders[now.a], &b = world.colliders[now.b];
  if (a.geometry->isHalfSpace() || b.geometry->isHalfSpace()) return;
  if (now.pierced || contacts.crossings().find(now.a, now.b)) return;
  WayOfPair way{now, wayOf(world, bodies, contacts, now.a, dt), wayOf(world, bodies, contacts, now.b, dt)};
  way.dt = dt;
  way.swing = ways_.swing(a.body) + ways_.swing(b.body);
  if (!way_.isDoubtful(way)) return;
  ways_.lead(a.body, &way.a.twist);
  ways_.lead(b.body, &way.b.twist);
  follow(world, contacts, flush, manifold, &way);
}

void ContactMeetings::lookAgain(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, const ContactStage& contacts,
                                const FlushSurfaces& flush, const Expectation& expected, std::size_t manifold, double dt) {
  const contact::ContactManifold& now = contacts.current()[manifold];
  if (expected.bodies.empty()) {
    std::vector<contact::Contact>* kept = room(manifold);
    kept->clear();
    std::copy_if(now.contacts.begin(), now.contacts.end(), std::back_inserter(*kept), touches);
    ++replaced_count_;
    return;
  }
  const auto way_of = [&](int collider) {
    const int body = world.colliders[collider].body;
    const BodyTwist at_hand = twistOf(world, bodies, body);
    ColliderWay way{&world.colliders[collider], contacts.motion()[collider].X_WC, at_hand.centre, at_hand};
    if (body == dynamics::WORLD_BODY) return way;
    way.twist = {at_hand.centre, expected.bodies[body].v_WCom, expected.bodies[body].w_WB};
    ways_.leadTo(body, expected.bodies[body].X_WB, &way.twist);
    return way;
  };
  WayOfPair way{now, way_of(now.a), way_of(now.b)};
  way.dt = dt;
  way.swing = changeOf(world, bodies, way);
  follow(world, contacts, flush, manifold, &way);
}

void ContactMeetings::look(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, const ContactStage& contacts,
                           const FlushSurfaces& flush, const Expectation& expected, double dt) {
  const std::vector<contact::ContactManifold>& manifolds = contacts.current();
  replaced_count_ = 0;
  ways_.start(world, bodies, dt);
  findSupports(world, manifolds);
  for (std::size_t m = 0; m < manifolds.size(); ++m) {
    if (contact::findPair(expected.pairs, manifolds[m].a, manifolds[m].b))
      lookAgain(world, bodies, contacts, flush, expected, m, dt);
    else
      lookAt(world, bodies, contacts, flush, m, dt);
  }
}

void ContactMeetings::exchange(std::vector<contact::ContactManifold>* manifolds) {
  for (std::size_t i = 0; i < replaced_count_; ++i) std::swap((*manifolds)[replaced_[i].manifold].contacts, replaced_[i].contacts);
}

}  // namespace blem_sim::sim
