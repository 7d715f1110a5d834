#include "island/last_resort.h"

#include "island/island_bounds.h"
#include "newton/island_faults.h"

namespace blem_sim::dynamics {
namespace {

constexpr double RECOVERED = 1e-7;  // of the largest impulse: change by which sweeps end
constexpr int POLISHES = 40;        // iterations of Newton's method after sweeps

}  // namespace

void LastResort::recover(const IslandAtHand& island, const IslandWays& ways, const NewtonSettings& settings, NewtonReport* report) {
  best_.take(island);
  least_ = faultsWithCreep(*report, island.terms()->contacts);
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
  best_.put(island);
  report->gradient = ways.newton->adopt();
  ways.newton->finish(report);
  if (!(least_ > 1)) return;
  ways.swept->freeVelocity(&island.space->direction);
  boundEnergy(island, island.space->direction);
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
