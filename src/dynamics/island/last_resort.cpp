#include "island/last_resort.h"

#include <algorithm>

#include "island/island_bounds.h"
#include "newton/island_faults.h"

namespace blem_sim::dynamics {

void LastResort::recover(const IslandAtHand& island, SweptIsland* swept, NewtonLoop* newton, NewtonReport* report) {
  double least = faultsWithCreep(*report, island.terms()->contacts);
  best_.take(island);
  for (const SweepStart start : {SweepStart::PREVIOUS, SweepStart::NOTHING}) {
    NewtonReport found;
    SweepReport sweeps;
    if (!swept->sweepWithMotors(start, &sweeps)) break;
    report->iterations += sweeps.sweeps;
    found.gradient = swept->adopt();
    newton->finish(&found);
    const double left = faultsWithCreep(found, island.terms()->contacts);
    if (left < least) best_.take(island);
    least = std::min(least, left);
    if (least <= 1) break;
  }
  best_.put(island);
  report->gradient = newton->adopt();
  newton->finish(report);
  if (!(least > 1)) return;
  swept->freeVelocity(&island.space->direction);
  boundEnergy(island, island.space->direction);
}

}  // namespace blem_sim::dynamics
