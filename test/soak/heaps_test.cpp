// Heaps: thirty cubes of twelve triangles that tumble onto each other, and pieces poured into a bin: no energy out of nothing, none lost.
#include <gtest/gtest.h>

#include <algorithm>

#include "soak/figures.h"
#include "soak/stirred_heap.h"

namespace blem_sim {
namespace {

class Heap : public ::testing::TestWithParam<int> {};

TEST_P(Heap, GainsNoEnergyAndLosesNone) {
  sim::Simulator simulator(heapOfCubes(GetParam(), soakSettings()), model::UriResolver());
  const std::string name = "heap " + std::to_string(GetParam());
  double out_of_nothing = 0;
  double energy = simulator.report().energy, gained = -INFINITY, lowest = INFINITY, deepest = 0, slowest_solve = 0, residual = 0;
  int gaining = 0, worst_at = 0, shortened = 0;
  StepTimes times;
  for (int k = 0; k < soakSteps(20, 2); ++k) {
    times.start();
    const sim::StepReport& report = simulator.step();
    times.stop(report);
    ASSERT_FALSE(report.status & sim::STATE_NOT_FINITE) << k;
    if (report.energy - energy > gained) worst_at = k;
    gained = std::max(gained, report.energy - energy);
    gaining += report.energy - energy >= 1e-6;
    energy = report.energy;
    out_of_nothing = std::max(out_of_nothing, report.energy_out_of_nothing);
    shortened += report.substeps > 1;
    deepest = std::max(deepest, report.max_of_layer);
    residual = std::max(residual, report.solver_residual);
    slowest_solve = std::max(slowest_solve, 1e6 * report.profile.seconds[static_cast<int>(sim::Stage::SOLVE)]);
    for (const dynamics::BodyState& body : report.bodies) lowest = std::min(lowest, body.X_WB.translation().z());
  }
  figure(name + ": energy gained in a step", gained, "J");
  figure(name + ": the same, island by island, without corrections of depth", out_of_nothing, "J");
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
  EXPECT_LT(out_of_nothing, 1e-6);
  EXPECT_GT(lowest, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Heap, ::testing::Range(1, 11));

/** Pieces at rest over a bin. */
struct Pour {
  const char* name;
  sim::SimulationConfig (*pour)(int count, int seed, const dynamics::SolverSettings& solver);
  int count;
  double seconds;  ///< simulated
  double rest;     ///< [m/s] at their end, at most: balls roll on, small parts settle slowly
};

/** Outcome of one heap. */
struct PourOutcome {
  double gained = 0, out_of_nothing = 0;  ///< [J] in a step, at most
  double deepest = 0;                     ///< of the layers
  double speed = 0;                       ///< [m/s] at the end, fastest
  int trouble = 0, told = 0, lost = 0;    ///< steps with SOLVER_TROUBLE, with ENERGY_GAINED; pieces outside the bin
};

PourOutcome pourOut(const sim::SimulationConfig& config, int steps, StepTimes* times) {
  sim::Simulator simulator(config, model::UriResolver());
  const Box bin = simulator.colliders()[0].geometry->bounds();
  PourOutcome outcome;
  for (int k = 0; k < steps; ++k) {
    times->start();
    const sim::StepReport& report = simulator.step();
    times->stop(report);
    EXPECT_FALSE(report.status & sim::STATE_NOT_FINITE) << k;
    outcome.gained = std::max(outcome.gained, report.energy_gained);
    outcome.out_of_nothing = std::max(outcome.out_of_nothing, report.energy_out_of_nothing);
    outcome.deepest = std::max(outcome.deepest, report.max_of_layer);
    outcome.trouble += (report.status & sim::SOLVER_TROUBLE) != 0;
    outcome.told += (report.status & sim::ENERGY_GAINED) != 0;
  }
  for (const dynamics::BodyState& body : simulator.report().bodies) {
    outcome.speed = std::max(outcome.speed, body.v_WCom.norm());
    outcome.lost += !bin.contains(body.X_WB.translation());
  }
  return outcome;
}

class Poured : public ::testing::TestWithParam<Pour> {};

TEST_P(Poured, SettlesWithoutEnergyOutOfNothing) {
  const Pour& pour = GetParam();
  PourOutcome worst;
  StepTimes times;
  const int seeds = soakShort() ? 1 : 10, steps = soakSteps(pour.seconds, 0.5);
  for (int seed = 1; seed <= seeds; ++seed) {
    const PourOutcome each = pourOut(pour.pour(pour.count, seed, soakSettings()), steps, &times);
    worst.gained = std::max(worst.gained, each.gained);
    worst.out_of_nothing = std::max(worst.out_of_nothing, each.out_of_nothing);
    worst.deepest = std::max(worst.deepest, each.deepest);
    worst.speed = std::max(worst.speed, each.speed);
    worst.trouble += each.trouble, worst.told += each.told, worst.lost += each.lost;
  }
  const std::string name = std::to_string(pour.count) + " " + pour.name;
  figure(name + ": energy gained in a step, corrections of depth included", worst.gained, "J");
  figure(name + ": out of nothing in a step", worst.out_of_nothing, "J");
  figure(name + ": steps that said ENERGY_GAINED", worst.told, "");
  figure(name + ": steps in trouble", worst.trouble, "");
  figure(name + ": deepest of layer", worst.deepest, "");
  figure(name + ": fastest at the end", worst.speed, "m/s");
  times.print(name);
  EXPECT_LT(worst.out_of_nothing, 1e-6);
  // The bit's bound shrinks with the mass of an island: 1e-8 J for a rod alone.
  EXPECT_LT(worst.told, 5e-3 * seeds * steps);
  EXPECT_LT(worst.trouble, 1e-3 * seeds * steps);
  EXPECT_LT(worst.deepest, 0.25);
  EXPECT_EQ(worst.lost, 0);
  if (!soakShort()) {
    EXPECT_LT(worst.speed, pour.rest);
  }
}

INSTANTIATE_TEST_SUITE_P(Heaps, Poured,
                         ::testing::Values(Pour{"exact spheres", spheresInBin, 108, 4, 0.01}, Pour{"rods", rodsInBin, 90, 4, 1e-5},
                                           Pour{"mixed parts", partsInBin, 100, 4, 1e-4}, Pour{"cubes", heapInBin, 30, 4, 1e-6}),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

class Stirred : public ::testing::TestWithParam<int> {};

TEST_P(Stirred, WithoutTrouble) {
  sim::Simulator simulator(stirredHeap(GetParam(), 1, soakSettings()), model::UriResolver());
  int trouble = 0, told = 0, saturated = 0;
  double out_of_nothing = 0, sum = 0, deepest = 0, speed = 0;
  StepTimes times;
  const int steps = soakSteps(4, 0.3);
  for (int k = 0; k < steps; ++k) {
    stir(&simulator);
    times.start();
    const sim::StepReport& report = simulator.step();
    times.stop(report);
    ASSERT_FALSE(report.status & sim::STATE_NOT_FINITE) << k;
    trouble += (report.status & sim::SOLVER_TROUBLE) != 0;
    told += (report.status & sim::ENERGY_GAINED) != 0;
    saturated += (report.status & sim::EFFORT_SATURATED) != 0;
    out_of_nothing = std::max(out_of_nothing, report.energy_out_of_nothing);
    sum += report.energy_out_of_nothing;
    deepest = std::max(deepest, report.max_of_layer);
    for (const dynamics::BodyState& body : report.bodies) speed = std::max(speed, body.v_WCom.norm());
  }
  const std::string name = std::to_string(GetParam()) + " cubes that are stirred";
  figure(name + ": steps in trouble", trouble, "");
  figure(name + ": steps with a motor at its bound", saturated, "");
  figure(name + ": steps that said ENERGY_GAINED", told, "");
  figure(name + ": most energy out of nothing in a step", out_of_nothing, "J");
  figure(name + ": in all", sum, "J");
  figure(name + ": deepest of layer", deepest, "");
  figure(name + ": fastest", speed, "m/s");
  times.print(name);
  EXPECT_LT(trouble, 1e-3 * steps);
  EXPECT_LT(sum, 1e-3);
  EXPECT_LT(deepest, 0.25);
}

INSTANTIATE_TEST_SUITE_P(Cubes, Stirred, ::testing::Values(40, 100, 300));

}  // namespace
}  // namespace blem_sim
