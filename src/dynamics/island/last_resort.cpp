#include "island/last_resort.h"

#include "island/island_bounds.h"
#include "newton/island_faults.h"

namespace blem_sim::dynamics {
namespace {

constexpr double RECOVERED = 1e-7;      // of the largest impulse: change by which sweeps end
constexpr int POLISHES = 40;            // iterations of Newton's method after sweeps
constexpr double WITHOUT_FAULT = 0.01;  // of the faults that are trouble: what proximal steps that go on are to end with
// Shares of what slips are off, by which they move while proximal steps go on: first all of it, as before iterations ran out. The others
// halve the miss of slips that are led away from by up to some ten times as much.
constexpr double SHARES[] = {1, 0.25, 0.0625};

}  // namespace

void LastResort::recover(const IslandAtHand& island, const IslandWays& ways, const NewtonSettings& settings, NewtonReport* report) {
  best_.take(island);
  least_ = faultsWithCreep(*report, island.terms()->contacts);
  const bool sweeps = faults(*report, island.terms()->contacts) > 1;
  if (!island.model.isSweptCrowd()) goOn(island, ways, settings, report);
  if (sweeps && least_ > 1) sweep(island, ways, settings, report);
  best_.put(island);
  report->gradient = ways.newton->adopt();
  ways.newton->finish(report);
  if (!(sweeps && least_ > 1)) return;
  ways.swept->freeVelocity(&island.space->direction);
  boundEnergy(island, island.space->direction);
}

void LastResort::goOn(const IslandAtHand& island, const IslandWays& ways, const NewtonSettings& settings, NewtonReport* report) {
  NewtonReport found = *report;
  for (const double share : SHARES) {
    found.iterations = 0;
    ways.newton->dampSlips(share);
    ways.steps->finish(settings, &found);
    report->iterations += found.iterations;
    take(island, found);
    if (least_ <= WITHOUT_FAULT) break;
  }
  ways.newton->dampSlips(1);
  best_.put(island);
}

void LastResort::sweep(const IslandAtHand& island, const IslandWays& ways, const NewtonSettings& settings, NewtonReport* report) {
  for (const SweepStart start : {SweepStart::PREVIOUS, SweepStart::NOTHING}) {
    NewtonReport found;
    SweepReport sweeps;
    if (!ways.swept->sweepWithMotors(start, RECOVERED, &sweeps)) break;
    report->iterations += sweeps.sweeps;
    found.gradient = ways.swept->adopt();
    ways.newton->finish(&found);
    take(island, found);
    if (least_ > 1 && island.model.joints > 0) report->iterations += polish(island, ways, settings);
    if (least_ <= 1) break;
  }
}

// Keeps a result that has fewer faults than the best one.
void LastResort::take(const IslandAtHand& island, const NewtonReport& found) {
  const double left = faultsWithCreep(found, island.terms()->contacts);
  if (!(left < least_)) return;
  best_.take(island);
  least_ = left;
}

// Newton's method from the impulses at hand. @return iterations
int LastResort::polish(const IslandAtHand& island, const IslandWays& ways, const NewtonSettings& settings) {
  NewtonSettings few = settings;
  few.max_iterations = POLISHES;
  NewtonReport found;
  const NewtonRun run = ways.newton->run({few.gradient_tolerance, 0, few.max_iterations});
  found.iterations = run.iterations;
  found.gradient = run.gradient;
  ways.steps->finish(few, &found);
  if (isExact(settings, found)) take(island, found);
  return found.iterations;
}

}  // namespace blem_sim::dynamics
