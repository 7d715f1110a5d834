#include "newton/newton_report.h"

#include <algorithm>

#include "problem/island_velocity.h"

namespace blem_sim::dynamics {
namespace {

constexpr double OF_FIRST_SPEED = 1e-3;  // creep of contacts that is none: of the fastest of them before the solve

}  // namespace

void assess(const IslandAtHand& island, const IslandIterate& iterate, NewtonReport* report) {
  report->imbalance = imbalance(island);
  const ContactResidual contact = iterate.reactions().contacts().residual();
  report->contact_residual = contact.impulse;
  report->contact_creep = std::max(0.0, contact.speed - OF_FIRST_SPEED * iterate.firstSpeed());
  report->joint_creep = iterate.reactions().joints().creep();
  for (const LoopTerm& loop : island.terms()->loops) report->joint_creep = std::max(report->joint_creep, loop.creep());
}

bool isExact(const NewtonSettings& settings, const NewtonReport& report) {
  return report.contact_residual <= settings.contact_tolerance && report.gradient <= settings.gradient_tolerance;
}

}  // namespace blem_sim::dynamics
