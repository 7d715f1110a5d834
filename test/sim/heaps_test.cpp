// Heaps, towers and mass ratios: many bodies that push each other, from any start, without a word of trouble.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "soak/stirred_heap.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

/** Figures of some steps. */
struct Seen {
  int trouble = 0;     ///< steps that said SOLVER_TROUBLE
  double gained = 0;   ///< [J] most in a step
  double speed = 0;    ///< [m/s] at the end, fastest body
  double deepest = 0;  ///< of the layers
  std::uint32_t status = 0;
};

Seen run(Simulator* simulator, double seconds) {
  Seen seen;
  const long steps = std::lround(seconds / simulator->config().time_step);
  for (long i = 0; i < steps; ++i) {
    const StepReport& report = simulator->step();
    seen.trouble += (report.status & SOLVER_TROUBLE) != 0;
    seen.gained = std::max(seen.gained, report.energy_gained);
    seen.deepest = std::max(seen.deepest, report.max_of_layer);
    seen.status |= report.status;
  }
  for (const dynamics::BodyState& body : simulator->report().bodies) seen.speed = std::max(seen.speed, body.v_WCom.norm());
  return seen;
}

SimulationConfig tower(int cubes) {
  SimulationConfig config;
  config.environments = {ground()};
  for (int i = 0; i < cubes; ++i)
    config.objects.push_back(box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, {0, 0, 0.055 + 0.105 * i}));
  return config;
}

TEST(Heaps, SixtyCubesTumbleWithoutTrouble) {
  Simulator simulator(heapInBin(60, 1, dynamics::SolverSettings()), model::UriResolver());
  const Seen seen = run(&simulator, SANITIZED ? 0.2 : 0.6);
  EXPECT_EQ(seen.trouble, 0);
  EXPECT_FALSE(seen.status & (STATE_NOT_FINITE | CONTACT_UNRELIABLE));
  EXPECT_LT(seen.deepest, 0.25);
}

// Newton's method took what its budget left: up to 1 % of the largest force.
TEST(Heaps, SmallOnesMissCoulombsLawByLittleWhileTheyTumble) {
  Simulator simulator(heapInBin(30, 1, dynamics::SolverSettings()), model::UriResolver());
  int tumbling = 0;
  for (int i = 0; i < (SANITIZED ? 450 : 700); ++i) {
    const StepReport& report = simulator.step();
    double largest = 0;
    for (const ContactReport& contact : report.contacts) largest = std::max(largest, contact.force.norm());
    ASSERT_LE(report.solver_residual, 2e-3 * largest) << i;
    tumbling += report.contacts.size() > 60;
  }
  EXPECT_GT(tumbling, SANITIZED ? 20 : 200);
}

// Newton's method alone, and sweeps that took a motor at its bound for a constant push, were in trouble in a fifth of the steps.
TEST(Heaps, AreStirredByAMotorAtItsBoundWithoutTrouble) {
  Simulator simulator(stirredHeap(100, 1, dynamics::SolverSettings()), model::UriResolver());
  int trouble = 0, saturated = 0;
  double out_of_nothing = 0;
  for (int i = 0; i < (SANITIZED ? 50 : 700); ++i) {
    stir(&simulator);
    const StepReport& report = simulator.step();
    ASSERT_FALSE(report.status & (STATE_NOT_FINITE | CONTACT_UNRELIABLE)) << i;
    trouble += (report.status & SOLVER_TROUBLE) != 0;
    saturated += (report.status & EFFORT_SATURATED) != 0;
    out_of_nothing = std::max(out_of_nothing, report.energy_out_of_nothing);
  }
  EXPECT_EQ(trouble, 0);
  EXPECT_GT(saturated, SANITIZED ? 0 : 500);
  EXPECT_LT(out_of_nothing, 1e-5);
}

TEST(Heaps, AreStirredToTheSameBitsByAnyNumberOfThreads) {
  std::vector<std::vector<double>> ends;
  for (const int threads : {1, 2}) {
    dynamics::SolverSettings solver;
    solver.threads = threads;
    Simulator simulator(stirredHeap(100, 1, solver), model::UriResolver());
    for (int i = 0; i < (SANITIZED ? 30 : 450); ++i) {
      stir(&simulator);
      simulator.step();
    }
    EXPECT_GT(simulator.report().reduced_contacts, SANITIZED ? -1 : 300);  // threads share islands of so many
    ends.push_back(simulator.world().save().numbers);
  }
  EXPECT_EQ(ends[0], ends[1]);
}

/** One of the cubes lands on a corner, is hit from above, and its other corner comes down within the step, where nothing had foreseen it.
 */
TEST(Heaps, WhatAHitBringsDownDoesNotLeapIntoItsLayer) {
  Simulator simulator(heapInBin(30, 3, dynamics::SolverSettings()), model::UriResolver());
  const Seen seen = run(&simulator, 0.22);
  EXPECT_TRUE(seen.status & STEP_SHORTENED);
  EXPECT_LT(seen.deepest, 0.25);
}

// Energy gained below the bound of ENERGY_GAINED corrects depth.
TEST(Heaps, PouredSpheresGainNoEnergy) {
  Simulator simulator(spheresInBin(64, 3, dynamics::SolverSettings()), model::UriResolver());
  const Seen seen = run(&simulator, SANITIZED ? 0.2 : 0.6);
  EXPECT_EQ(seen.trouble, 0);
  EXPECT_FALSE(seen.status & (STATE_NOT_FINITE | CONTACT_UNRELIABLE | ENERGY_GAINED));
  EXPECT_LT(seen.gained, 3e-6);
}

TEST(Heaps, TowersOfTwentyAndThirtyRest) {
  for (const int cubes : SANITIZED ? std::vector<int>{20} : std::vector<int>{20, 30}) {
    Simulator simulator(tower(cubes), model::UriResolver());
    const Seen seen = run(&simulator, SANITIZED ? 1 : 2);
    EXPECT_EQ(seen.trouble, 0) << cubes;
    EXPECT_LT(seen.speed, 1e-6) << cubes;
    EXPECT_LT(seen.gained, 1e-6) << cubes;
  }
}

TEST(Heaps, ATowerOfAHundredThatLandsAtOnceRests) {
  Simulator simulator(tower(SANITIZED ? 40 : 100), model::UriResolver());
  const Seen seen = run(&simulator, 0.5);
  EXPECT_EQ(seen.trouble, 0);
  EXPECT_FALSE(seen.status & ENERGY_GAINED);
  EXPECT_LT(seen.speed, 1e-9);
}

/** What is heavy, over light things that carry it: masses [kg], and fall [m] before it lands. */
struct Load {
  double light, heavy, fall;
};
class Loads : public ::testing::TestWithParam<Load> {
 protected:
  /** The load at a place over what carries it falls, lands and rests. @param resting [m] height of its centre then */
  void expectRests(SimulationConfig config, const Vector3& size, const Vector3& place, double resting) const {
    const Load& load = GetParam();
    config.environments = {ground()};
    config.objects.push_back(box("load", size, load.heavy, place + Vector3(0, 0, load.fall)));
    Simulator simulator(config, model::UriResolver());
    const Seen seen = run(&simulator, 0.6 + std::sqrt(2 * load.fall / G));
    EXPECT_EQ(seen.trouble, 0);
    EXPECT_FALSE(seen.status & ENERGY_GAINED);
    EXPECT_LT(seen.speed, 1e-9);
    EXPECT_NEAR(bodyOf(simulator, "load").X_WB.translation().z(), resting, 1e-5);
  }
};

// Contacts in a row give by as much as all of them together, against the heavy body's inertia.
TEST_P(Loads, RestOnTwentySheets) {
  SimulationConfig config;
  const double pitch = 0.0051;
  for (int i = 0; i < 20; ++i) {
    const Pose X_WO = makePose({0.003 * (i % 3), 0.002 * (i % 2), pitch * (i + 1)}, {0, 0, 0.1 * i});
    config.objects.push_back(sheet("sheet" + std::to_string(i), 0.2, GetParam().light, X_WO));
  }
  expectRests(config, Vector3::Constant(0.1), {0.02, 0.01, 21 * pitch + 0.05}, 0.1525);
}

TEST_P(Loads, RestOnTwentyPebbles) {
  SimulationConfig config;
  for (int i = 0; i < 20; ++i) {
    ObjectConfig pebble = box("pebble" + std::to_string(i), Vector3::Constant(0.01), 0.1 * GetParam().light, Vector3::Zero());
    pebble.X_WO = makePose({0.05 * (i % 5) - 0.1 + 0.003 * (i % 3), 0.06 * (i / 5) - 0.09, 0.0101}, {0, 0, 0.7 * i});
    config.objects.push_back(pebble);
  }
  expectRests(config, {0.3, 0.3, 0.05}, {0, 0, 0.0453}, 0.0425);
}

const std::vector<Load> LOADS = {{0.01, 100, 0}, {0.01, 100, 0.05}, {0.01, 100, 2}, {0.01, 1000, 0.3}, {0.005, 50, 0.1}, {0.02, 30, 0.3}};
INSTANTIATE_TEST_SUITE_P(Heaps, Loads, ::testing::ValuesIn(LOADS.begin(), LOADS.begin() + (SANITIZED ? 2 : 6)));

/** Rows of cubes of 1 kg, each one shorter than the one below; they fall onto each other by some millimetres. */
SimulationConfig wall(int length, int rows) {
  SimulationConfig config;
  config.environments = {ground(20)};
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < length - row; ++i)
      config.objects.push_back(box("cube" + std::to_string(config.objects.size()), Vector3::Constant(0.1), 1,
                                   {0.11 * i + 0.055 * row - 0.5, 0, 0.055 + 0.106 * row}));
  return config;
}

TEST(Heaps, APyramidRests) {
  constexpr int ROWS = SANITIZED ? 6 : 10;
  Simulator simulator(wall(ROWS, ROWS), model::UriResolver());
  const Seen seen = run(&simulator, 0.5);
  EXPECT_EQ(seen.trouble, 0);
  EXPECT_FALSE(seen.status & ENERGY_GAINED);
  EXPECT_LT(seen.speed, 1e-9);
}

/** Length of the lowest row, and number of rows. */
class StandingWalls : public ::testing::TestWithParam<std::pair<int, int>> {};

// Their proximal steps end balanced, within their iterations: swept ones, or none of them exact, would sway for ever.
TEST_P(StandingWalls, RestAndBearTheirWeight) {
  const auto [length, rows] = GetParam();
  Simulator simulator(wall(length, rows), model::UriResolver());
  const Seen seen = run(&simulator, 0.3);
  EXPECT_EQ(seen.trouble, 0);
  EXPECT_FALSE(seen.status & (ENERGY_GAINED | CONTACT_UNRELIABLE));
  EXPECT_LT(seen.speed, 1e-6);
  const double weight = simulator.report().bodies.size() * G;
  EXPECT_LT((forceOfWorld(simulator.report()) - Vector3(0, 0, weight)).norm(), 1e-5 * weight);
}

const std::vector<std::pair<int, int>> WALLS = {{8, 8}, {16, 16}, {18, 18}, {36, 5}, {36, 9}};
INSTANTIATE_TEST_SUITE_P(Heaps, StandingWalls, ::testing::ValuesIn(WALLS.begin(), WALLS.begin() + (SANITIZED ? 1 : 5)));

TEST(Heaps, CrowdsAreSharedByThreadsUnaskedToTheSameBits) {
  SimulationConfig alone = wall(36, 9);
  alone.solver.threads = 1;
  Simulator one(alone, model::UriResolver()), chosen(wall(36, 9), model::UriResolver());
  for (Simulator* simulator : {&one, &chosen}) run(simulator, 0.05);
  EXPECT_GT(chosen.report().reduced_contacts, static_cast<int>(dynamics::CROWDED));
  EXPECT_EQ(chosen.stateHash(), one.stateHash());
}

/** A wall of 159 cubes: more than 150 are a crowd. */
class CrowdAtRest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (SANITIZED) GTEST_SKIP() << "159 cubes take long under sanitizers";
    simulator_ = std::make_unique<Simulator>(wall(80, 2), model::UriResolver());
    const Seen seen = run(simulator_.get(), 0.6);
    EXPECT_EQ(seen.trouble, 0);
    EXPECT_FALSE(seen.status & ENERGY_GAINED);
    EXPECT_LT(seen.speed, 1e-9);
  }
  /** Pushes the last cube of the top row, at its centre, along x, from now on. */
  void push(double force) {
    const int body = simulator_->models()[simulator_->modelIndex("cube158")].bodies[0];
    simulator_->applyLoad({body, {{force, 0, 0}, Vector3::Zero()}, Vector3::Zero()}, {0, -1});
  }

  std::unique_ptr<Simulator> simulator_;
};

TEST_F(CrowdAtRest, HoldsWhatFrictionCarries) {
  push(1);
  const Seen seen = run(simulator_.get(), 0.1);
  EXPECT_EQ(seen.trouble, 0);
  EXPECT_LT(seen.speed, 1e-9);
  EXPECT_LT((forceOfWorld(simulator_->report()) - Vector3(-1, 0, 159 * G)).norm(), 1e-5);
}

TEST_F(CrowdAtRest, LetsSlideWhatFrictionDoesNotCarry) {
  push(8);
  run(simulator_.get(), 0.05);
  EXPECT_NEAR(bodyOf(*simulator_, "cube158").v_WCom.x(), 0.05 * (8 - 0.5 * G), 1e-3);
}

TEST(Heaps, AThousandTonsRestOnAKilogram) {
  SimulationConfig config = tower(2);
  config.objects[1].mass = 1e6;
  Simulator simulator(config, model::UriResolver());
  const Seen seen = run(&simulator, 1);
  EXPECT_EQ(seen.trouble, 0);
  EXPECT_LT(seen.speed, 1e-6);
  // Layers of 2.5 mm: of the ground none, of each cube on either side.
  EXPECT_NEAR(bodyOf(simulator, "cube1").X_WB.translation().z(), 0.05 + 0.1 + 3 * 0.0025, 1e-5);
}

TEST(Heaps, SizesFromATenthOfAMillimetreToAHundredMetresRest) {
  for (const double size : {1e-4, 1e-3, 1e-2, 10.0, 100.0}) {
    SimulationConfig config;
    config.environments = {ground(1000)};
    config.contact.boundary_width = 0.025 * size;
    for (int i = 0; i < 3; ++i)
      config.objects.push_back(
          box("cube" + std::to_string(i), Vector3::Constant(size), 1000 * size * size * size, {0, 0, (0.55 + 1.06 * i) * size}));
    Simulator simulator(config, model::UriResolver());
    EXPECT_LT(run(&simulator, size > 1 ? 4 : 0.5).speed, 1e-6 * size) << size;
  }
}

TEST(Heaps, AreTheSameOnOneThreadAndTwo) {
  std::uint64_t hashes[2];
  for (const int threads : {1, 2}) {
    dynamics::SolverSettings solver;
    solver.threads = threads;
    Simulator simulator(heapInBin(40, 2, solver), model::UriResolver());
    run(&simulator, SANITIZED ? 0.1 : 0.4);
    hashes[threads - 1] = simulator.stateHash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Heaps, ReplayFromAStateSavedWhileTheyTumble) {
  Simulator simulator(heapInBin(40, 2, dynamics::SolverSettings()), model::UriResolver());
  run(&simulator, SANITIZED ? 0.1 : 0.3);
  const SimulationState state = simulator.save();
  run(&simulator, 0.1);
  const std::uint64_t hash = simulator.stateHash();
  simulator.restore(state);
  run(&simulator, 0.1);
  EXPECT_EQ(simulator.stateHash(), hash);
}

}  // namespace
}  // namespace blem_sim::sim
