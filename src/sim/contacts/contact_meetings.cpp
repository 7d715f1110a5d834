#include "contacts/contact_meetings.h"

#include <algorithm>

#include "blem_sim/contact/collider_pairs.h"
#include "contacts/contact_stage.h"

namespace blem_sim {
namespace {

constexpr double BEARING_GAP = 1e-6;  // [m] largest gap of a contact that bears a body

}  // namespace

void ContactMeetings::findSupports(const SimulatedWorld& world, const std::vector<ContactManifold>& manifolds) {
  supports_.assign(world.world.bodyCount(), Support());
  for (const ContactManifold& manifold : manifolds) {
    const double depth = manifold.maxDepth();
    if (depth < -BEARING_GAP) continue;
    for (const int collider : {manifold.a, manifold.b}) {
      const int body = world.colliders[collider].body;
      if (body == WORLD_BODY) continue;
      supports_[body].touches = true;
      supports_[body].depth = std::max(supports_[body].depth, depth);
    }
  }
}

double ContactMeetings::depthOf(const SimulatedWorld& world, int collider) const {
  const int body = world.colliders[collider].body;
  return body == WORLD_BODY ? 0 : supports_[body].depth;
}

/** Way of a collider. An object that touches nothing falls; other bodies are borne by their contacts or motors. */
ColliderWay ContactMeetings::wayOf(const SimulatedWorld& world, const std::vector<BodyState>& bodies, const ContactStage& contacts,
                                   int collider, double dt) const {
  const Collider& c = world.colliders[collider];
  const BodyTwist now = twistOf(world, bodies, c.body);
  ColliderWay way{&c, contacts.motion()[collider].X_WC, now.centre, now};
  if (c.body != WORLD_BODY && world.models[c.model].kind == ModelKind::OBJECT && !supports_[c.body].touches)
    way.twist.v += dt * world.world.gravity();
  return way;
}

void ContactMeetings::look(const SimulatedWorld& world, const std::vector<BodyState>& bodies, const ContactStage& contacts,
                           const FlushSurfaces& flush, double dt) {
  const std::vector<ContactManifold>& manifolds = contacts.current();
  replaced_count_ = 0;
  ways_.start(world, bodies, dt);
  findSupports(world, manifolds);
  for (std::size_t m = 0; m < manifolds.size(); ++m) {
    const ContactManifold& manifold = manifolds[m];
    const Collider &a = world.colliders[manifold.a], &b = world.colliders[manifold.b];
    if (a.geometry->isHalfSpace() || b.geometry->isHalfSpace()) continue;
    if (manifold.pierced || contacts.crossings().find(manifold.a, manifold.b)) continue;
    WayOfPair way{manifold, wayOf(world, bodies, contacts, manifold.a, dt), wayOf(world, bodies, contacts, manifold.b, dt)};
    way.dt = dt;
    way.fading = &contacts.fading();
    way.swing = ways_.swing(a.body) + ways_.swing(b.body);
    if (!way_.isDoubtful(way)) continue;
    ways_.lead(a.body, &way.a.twist);
    ways_.lead(b.body, &way.b.twist);
    way.known = findPair(contacts.watched(), manifold.a, manifold.b)->known;
    way.depth = std::max(depthOf(world, manifold.a), depthOf(world, manifold.b));
    if (replaced_.size() == replaced_count_) replaced_.emplace_back();
    Replaced& replaced = replaced_[replaced_count_];
    replaced.manifold = m;
    if (way_.follow(way, flush, world.colliders, contacts.motion(), &replaced.contacts)) ++replaced_count_;
  }
}

void ContactMeetings::exchange(std::vector<ContactManifold>* manifolds) {
  for (std::size_t i = 0; i < replaced_count_; ++i) std::swap((*manifolds)[replaced_[i].manifold].contacts, replaced_[i].contacts);
}

}  // namespace blem_sim
