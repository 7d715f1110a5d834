#include "island/island_bounds.h"

#include <algorithm>
#include <cmath>

#include "problem/island_velocity.h"

namespace blem_sim::dynamics {
namespace {

constexpr double AT_TARGET = 4;         // times the energy of an island as fast as its fastest target: most that correcting depth may take
constexpr double OF_CORRECTION = 0.25;  // of a gain of energy: the least share of contacts that gained it by correcting depth

double fastestTarget(const IslandAtHand& island) {
  double fastest = 0;
  for (const ContactTerm& c : island.terms()->contacts) fastest = std::max(fastest, c.target);
  return fastest;
}

// Contacts of a body that friction locks, as in a groove, correct depth by no force, however large: they only keep bodies from coming
// closer. @return whether there is one
bool giveUpLocked(const IslandAtHand& island, double speed) {
  const double hard = island.model.hardPush(speed);
  bool any = false;
  for (ContactTerm& c : island.terms()->contacts) {
    if (!(c.target > 0) || c.compliance > 0 || c.normal.dot(c.impulse) < hard) continue;
    c.target = 0;
    any = true;
  }
  return any;
}

// Contacts that lead bodies apart, and loops that close, need the energy of bodies that move at their targets. Contacts that hardly have a
// lever, or leave bodies no other way, would add any amount. @return share of the targets that is to be reached
double affordableShare(const IslandAtHand& island, double speed) {
  const IslandTerms& terms = *island.terms();
  const double fastest = std::max(speed, fastestTarget(island)), enough = AT_TARGET * 0.5 * island.model.mass * fastest * fastest;
  double work = 0;
  for (const ContactTerm& c : terms.contacts) work += std::max(0.0, c.normal.dot(c.impulse)) * std::max(0.0, c.target);
  for (const LoopTerm& loop : terms.loops) work += loop.impulses().cwiseProduct(loop.target).cwiseMax(0.0).sum();
  if (!(work > enough)) return 1;
  const double before = kineticEnergy(island, island.motion.velocity), after = kineticEnergy(island, island.space->velocity);
  const double most = std::sqrt(before) + std::sqrt(enough), is = std::sqrt(after);
  return is > most && work > OF_CORRECTION * (after - before) ? std::sqrt(enough) / is : 1;
}

}  // namespace

bool boundCorrections(const IslandAtHand& island, double speed) {
  const double share = affordableShare(island, speed);
  const bool limited = giveUpLocked(island, speed) || share < 1;
  if (!limited) return false;
  for (ContactTerm& c : island.terms()->contacts) c.target = std::min(c.target, share * c.target);
  for (LoopTerm& loop : island.terms()->loops) loop.target *= share;
  return true;
}

void boundEnergy(const IslandAtHand& island, const Eigen::VectorXd& free_velocity) {
  SolverSpace& s = *island.space;
  const double fastest = fastestTarget(island);
  const double most = kineticEnergy(island, free_velocity) + 0.5 * island.model.mass * fastest * fastest;
  const double moves = kineticEnergy(island, s.velocity);
  if (moves <= most) return;
  const double share = std::isfinite(moves) && std::isfinite(most) ? std::sqrt(most / moves) : 0;
  forDofs(island, [&](int k) {
    s.velocity[k] = share > 0 ? share * s.velocity[k] : 0;
    s.mass_velocity[k] = share > 0 ? share * s.mass_velocity[k] : 0;
  });
}

}  // namespace blem_sim::dynamics
