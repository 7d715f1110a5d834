// Thirty cubes of twelve triangles tumble onto each other: no energy out of nothing, none through the ground.
#include <gtest/gtest.h>

#include "soak/figures.h"
#include "soak/heap.h"

namespace blem_sim {
namespace {

class Heap : public ::testing::TestWithParam<int> {};

TEST_P(Heap, GainsNoEnergyAndLosesNone) {
  Simulator simulator(heapOfCubes(GetParam(), soakSettings()), UriResolver());
  const std::string name = "heap " + std::to_string(GetParam());
  double energy = simulator.report().energy, gained = -INFINITY, lowest = INFINITY, deepest = 0, slowest_solve = 0, residual = 0;
  int gaining = 0, worst_at = 0, shortened = 0;
  StepTimes times;
  for (int k = 0; k < soakSteps(20, 2); ++k) {
    times.start();
    const StepReport& report = simulator.step();
    times.stop(report);
    ASSERT_FALSE(report.status & STATE_NOT_FINITE) << k;
    if (report.energy - energy > gained) worst_at = k;
    gained = std::max(gained, report.energy - energy);
    gaining += report.energy - energy >= 1e-6;
    energy = report.energy;
    shortened += report.substeps > 1;
    deepest = std::max(deepest, report.max_of_layer);
    residual = std::max(residual, report.solver_residual);
    slowest_solve = std::max(slowest_solve, 1e6 * report.profile.seconds[static_cast<int>(Stage::SOLVE)]);
    for (const BodyState& body : report.bodies) lowest = std::min(lowest, body.X_WB.translation().z());
  }
  figure(name + ": energy gained in a step", gained, "J");
  figure(name + ": that step", worst_at, "");
  figure(name + ": steps that gained 1e-6 J", gaining, "");
  figure(name + ": lowest centre", lowest, "m");
  figure(name + ": kinetic energy at the end", simulator.world().kineticEnergy(), "J");
  figure(name + ": deepest of layer", deepest, "");
  figure(name + ": worst residual", residual, "N");
  figure(name + ": steps shortened", shortened, "");
  figure(name + ": slowest solve, wall", slowest_solve, "us");
  times.print(name);
  EXPECT_LT(gained, 1e-6);
  EXPECT_GT(lowest, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Heap, ::testing::Range(1, 11));

}  // namespace
}  // namespace blem_sim
