#include "contacts/constraints/pair_way.h"

#include <algorithm>
#include <limits>

#include "contacts/constraints/contact_ids.h"

namespace blem_sim::sim {
namespace {

constexpr double SEARCH_SPACING = 0.5;  // layers between two searches on the way
constexpr double LONGEST = 1.0 / 16;    // of the solve between two searches where there is no layer
constexpr double SHORTEST = 1.0 / 512;  // of the solve between two searches
constexpr int MOST_SEARCHES = 256;
constexpr double SAME_NORMAL = 0.02;  // sine

Vector3 relativeVelocity(const WayOfPair& pair, const Vector3& point) { return pair.a.twist.at(point) - pair.b.twist.at(point); }

/** Closing speed [m/s]. */
double closing(const WayOfPair& pair, const contact::Contact& contact) {
  return -contact.normal_BA.dot(relativeVelocity(pair, contact.point));
}

/** Distance [m] that the pair may close along a contact's normal in the solve. */
double reach(const WayOfPair& pair, const contact::Contact& contact) { return (closing(pair, contact) + pair.swing) * pair.dt; }

bool acts(const WayOfPair& pair, const contact::Contact& contact) { return !touches(contact) && reach(pair, contact) > -contact.depth; }

/** The contact of a later pose as the bodies have it at the start: with the levers of that pose, and with the gap that their motion closes
 * until then. */
contact::Contact seenFromStart(const WayOfPair& pair, const contact::Contact& contact, double time) {
  contact::Contact seen = contact;
  const bool a_moves = pair.a.collider->body != dynamics::WORLD_BODY, b_moves = pair.b.collider->body != dynamics::WORLD_BODY;
  seen.point -= time / (a_moves + b_moves) * (pair.a.twist.at(pair.a.com) + pair.b.twist.at(pair.b.com));
  seen.depth -= time * closing(pair, seen);
  return seen;
}

void sortById(std::vector<contact::Contact>* contacts) {
  std::sort(contacts->begin(), contacts->end(), [](const contact::Contact& a, const contact::Contact& b) { return a.id < b.id; });
}

/** The contact of an id among contacts sorted by id; null if there is none. */
template <typename It>
const contact::Contact* find(It begin, It end, std::uint64_t id) {
  const auto place =
      std::lower_bound(begin, end, id, [](const contact::Contact& contact, std::uint64_t wanted) { return contact.id < wanted; });
  return place != end && place->id == id ? &*place : nullptr;
}

}  // namespace

bool bears(const SimulatedWorld& world, const contact::ContactManifold& pair, const contact::Contact& contact) {
  return touches(contact) || world.world.pushed(worldContactId(pair.a, pair.b, contact.id));
}

bool PairWay::isDoubtful(const WayOfPair& pair) const {
  return std::any_of(pair.now.contacts.begin(), pair.now.contacts.end(), [&](const contact::Contact& contact) {
    if (!acts(pair, contact)) return false;
    const Vector3 velocity = relativeVelocity(pair, contact.point);
    const Vector3 across = velocity - contact.normal_BA.dot(velocity) * contact.normal_BA;
    return across.norm() * pair.dt * -contact.depth > ACROSS * pair.now.layer * reach(pair, contact);
  });
}

bool PairWay::touchesNow(std::uint64_t id) const { return std::binary_search(touching_.begin(), touching_.end(), id); }

/** Time [s] in which the contacts surely do not touch anew: distances of convex features that move on straight shrink ever slower. */
double PairWay::freeTime(const WayOfPair& pair, const std::vector<contact::Contact>& contacts, double time) const {
  double free = pair.dt, fastest = 0;
  for (const contact::Contact& contact : contacts) {
    fastest = std::max(fastest, relativeVelocity(pair, contact.point).norm());
    if (touchesNow(contact.id)) continue;
    contact::Contact here = contact;
    here.depth = 0;
    const double speed = closing(pair, seenFromStart(pair, here, time));
    if (speed > 0) free = std::min(free, (pair.depth + TOUCHING - contact.depth) / speed);
  }
  const double most = pair.now.layer > 0 ? SEARCH_SPACING * pair.now.layer / fastest : LONGEST * pair.dt;
  return std::max(SHORTEST * pair.dt, std::min(free, most));
}

/** Depth [m] of the deepest contact that does not touch at the start. */
double PairWay::newDepth(const std::vector<contact::Contact>& contacts) const {
  double depth = -std::numeric_limits<double>::infinity();
  for (const contact::Contact& contact : contacts)
    if (contact.depth > depth && !touchesNow(contact.id)) depth = contact.depth;
  return depth;
}

/** Searches the pose where the pair meets, or is nearest: met_, met_time_. @return false if it cannot be told */
bool PairWay::search(const WayOfPair& pair, const FlushSurfaces& flush, const std::vector<contact::Collider>& colliders,
                     const std::vector<contact::ColliderMotion>& motion) {
  double time = std::min(pair.dt, freeTime(pair, pair.now.contacts, 0)), nearest = -std::numeric_limits<double>::infinity();
  at_.a = pair.now.a, at_.b = pair.now.b;
  met_.contacts.clear();
  for (int i = 0; i < MOST_SEARCHES; ++i) {
    contact::narrowPhase({*pair.a.collider, pair.a.twist.moved(pair.a.X_WC, time)},
                         {*pair.b.collider, pair.b.twist.moved(pair.b.X_WC, time)}, {pair.known}, pair.workspace, &at_);
    if (at_.pierced) return false;
    flush.dropCovered(colliders, motion, &cover_, &at_);
    pair.fading->apply(colliders, &at_);
    const double depth = newDepth(at_.contacts), next = time + freeTime(pair, at_.contacts, time);
    touches_ = depth > pair.depth + 0.5 * TOUCHING;
    if (touches_ || depth > nearest) {
      nearest = depth;
      met_time_ = time;
      std::swap(met_.contacts, at_.contacts);
    }
    if (touches_ || time >= pair.dt) return true;
    time = std::min(pair.dt, next);
  }
  return false;
}

bool PairWay::isMetAsItIs(const contact::Contact& contact) const {
  const contact::Contact* const met = find(met_.contacts.begin(), met_.contacts.end(), contact.id);
  return met && (met->normal_BA - contact.normal_BA).norm() < SAME_NORMAL;
}

bool PairWay::follow(const WayOfPair& pair, const FlushSurfaces& flush, const std::vector<contact::Collider>& colliders,
                     const std::vector<contact::ColliderMotion>& motion, std::vector<contact::Contact>* contacts) {
  touching_.clear();
  for (const contact::Contact& contact : pair.now.contacts)
    if (touches(contact)) touching_.push_back(contact.id);
  std::sort(touching_.begin(), touching_.end());
  if (!search(pair, flush, colliders, motion)) return false;
  sortById(&met_.contacts);
  contacts->clear();
  for (const contact::Contact& contact : pair.now.contacts)
    if (!acts(pair, contact) || (touches_ ? isMetAsItIs(contact) : bears(pair.world, pair.now, contact))) contacts->push_back(contact);
  const std::size_t kept = contacts->size();
  if (kept == pair.now.contacts.size()) return false;
  sortById(contacts);
  for (const contact::Contact& contact : met_.contacts) {
    if (find(contacts->begin(), contacts->begin() + kept, contact.id)) continue;
    contact::Contact seen = seenFromStart(pair, contact, met_time_);
    if (reach(pair, seen) < -TOUCHING) continue;  // behind the pair by then
    if (!touches_) seen.depth = std::min(seen.depth, -(reach(pair, seen) + TOUCHING));
    contacts->push_back(seen);
  }
  sortById(contacts);
  return true;
}

}  // namespace blem_sim::sim
