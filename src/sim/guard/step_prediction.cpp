#include "guard/step_prediction.h"

#include <algorithm>
#include <cmath>

#include "blem_sim/contact/collider_pairs.h"
#include "contacts/motion/meeting_speed.h"

namespace blem_sim::sim {
namespace {

constexpr double USED_UP_AHEAD = 0.9;  // of the distance between bare meshes
constexpr double PER_SOLVE = 0.5;      // layers that two bodies that touch may move in one solve
// A margin is at least 1.5 times the largest motion: a pair of a smaller margin is no danger to its layer.
constexpr double LEAST_MARGIN = 1.5 * PER_SOLVE;  // layers

/** safeTime of one pair. */
double safeTimeOf(const WatchedPair& pair, const SimulatedWorld& world, const FoundContacts& contacts,
                  const std::vector<dynamics::BodyState>& bodies, double time) {
  const double layer = world.colliders[pair.a].radius + world.colliders[pair.b].radius;
  if (!(layer > 0) || pair.margin <= LEAST_MARGIN * layer) return time;
  if (meetingSpeedBound(world, bodies, contacts.watched.motion, pair) * time <= PER_SOLVE * layer) return time;
  const contact::ContactManifold* manifold = contact::findPair(contacts.manifolds, pair.a, pair.b);
  const double gap = std::min(pair.known, manifold ? -contacts.depthOf(*manifold) : pair.known);  // between the layers, at least
  const double harmless = std::max(PER_SOLVE * layer, std::min(pair.known, USED_UP_AHEAD * (layer + gap)));
  const double speed = meetingSpeed(world, bodies, contacts.watched.motion, pair);
  if (speed * time <= harmless) return time;
  return std::min(time, std::max(gap, PER_SOLVE * layer) / speed);
}

}  // namespace

double safeTime(const SimulatedWorld& world, const FoundContacts& contacts, const std::vector<dynamics::BodyState>& bodies, double time) {
  double safe = time;
  for (const WatchedPair& pair : contacts.watched.pairs) safe = std::min(safe, safeTimeOf(pair, world, contacts, bodies, time));
  return safe;
}

}  // namespace blem_sim::sim
