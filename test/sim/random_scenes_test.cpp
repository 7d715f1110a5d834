// Three hundred random scenes, some of things that roll, and some in which things happen; scripts/validate_random_scenes runs thousands, or
// one of them alone.
#include <gtest/gtest.h>

#include <utility>

#include "support/random/eventful_scene.h"
#include "support/random/round_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

const int GROUPS = 20, SCENES_OF_GROUP = samples(15);
constexpr double START = 0.15;                       // [s] of each of three hundred: all of them in less than a minute
constexpr double EVENTFUL = SANITIZED ? 0.05 : 0.2;  // [s] of each in which things happen, several in a quarter of it too

/** @param options of the script that runs the scene again */
void expectSound(const SceneOutcome& outcome, const RandomScene& scene, const char* options = "") {
  EXPECT_FALSE(outcome.failed()) << outcome.failure << ": " << outcome.details << "\n"
                                 << scene.description << "\nscripts/validate_random_scenes" << options << " --seed " << outcome.seed;
}

void expectSound(std::uint64_t seed, double duration, bool round = false) {
  SceneOutcome outcome;
  outcome.seed = seed;
  const RandomScene scene = sceneOf(seed, round);
  runRandomScene(scene, duration, &outcome);
  expectSound(outcome, scene, round ? " --round" : "");
}

class RandomScenes : public ::testing::TestWithParam<int> {};

TEST_P(RandomScenes, StayFiniteAndGainNoEnergyUntold) {
  for (int i = 0; i < SCENES_OF_GROUP; ++i) expectSound(1 + static_cast<std::uint64_t>(GetParam() * SCENES_OF_GROUP + i), START);
}
INSTANTIATE_TEST_SUITE_P(Groups, RandomScenes, ::testing::Range(0, GROUPS));

class RoundScenes : public ::testing::TestWithParam<int> {};

TEST_P(RoundScenes, StaySoundAndGoThroughNoWall) {
  for (int i = 0; i < samples(8); ++i) expectSound(1 + static_cast<std::uint64_t>(8 * GetParam() + i), 0.06, true);
}
INSTANTIATE_TEST_SUITE_P(Groups, RoundScenes, ::testing::Range(0, 8));

/** Seeds that failed once, each for as long as it took [s]. */
class RandomScenesFound : public ::testing::TestWithParam<std::pair<int, double>> {};

TEST_P(RandomScenesFound, AreSound) {
  const auto [seed, duration] = GetParam();
  expectSound(static_cast<std::uint64_t>(seed), SANITIZED ? 0.02 * duration : duration);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomScenesFound,
                         ::testing::Values(std::pair(28, 1.0), std::pair(52, 1.0), std::pair(61, 1.0), std::pair(74, 1.0),
                                           std::pair(103, 1.0), std::pair(163, 1.0), std::pair(180, 1.0), std::pair(236, 1.0),
                                           std::pair(265, 1.0), std::pair(3937, 0.25), std::pair(5694, 0.3), std::pair(8854, 0.35),
                                           std::pair(9600, 0.1), std::pair(41328, 0.14), std::pair(86531, 0.2)));

// A gram wedged in a small heap of things of up to 780 kg creeps beyond what sweeps and their polish leave: proximal steps go on.
TEST(WedgedInAHeap, HardlyAnyStepIsInTrouble) {
  SceneOutcome outcome;
  outcome.seed = 200178;
  const RandomScene scene = randomScene(outcome.seed);
  runRandomScene(scene, SANITIZED ? 0.05 : 1, &outcome);
  expectSound(outcome, scene);
  int trouble = 0;
  while (1 << trouble != SOLVER_TROUBLE) ++trouble;
  EXPECT_LT(outcome.bits[trouble], 20);
}

void expectSoundWhateverHappens(std::uint64_t seed, double duration = EVENTFUL, bool live = false) {
  SceneOutcome outcome;
  const RandomScene scene = randomScene(seed);
  EventfulScene(scene, seed, live, &outcome).run(duration);
  expectSound(outcome, scene, live ? " --live" : " --eventful");
}

std::uint64_t hashAfter(RandomScene scene, int threads, int steps) {
  scene.config.solver.threads = threads;
  Simulator simulator(scene.config, model::UriResolver());
  commandRobots(scene, &simulator);
  for (int i = 0; i < steps; ++i) simulator.step();
  return simulator.stateHash();
}

// Two robots that tumble, one with mimic joints (103), once wrote into each other's work space.
TEST(ThreadsOfRandomScenes, MakeTheSameBits) {
  for (int i = 0; i < samples(40); ++i) {
    const std::uint64_t seed = 103 + static_cast<std::uint64_t>(i);
    const RandomScene scene = randomScene(seed), round = roundScene(seed);
    EXPECT_EQ(hashAfter(scene, 1, 60), hashAfter(scene, 2, 60)) << scene.description;
    EXPECT_EQ(hashAfter(round, 1, 20), hashAfter(round, 2, 20)) << round.description;
  }
}

class EventfulScenes : public ::testing::TestWithParam<int> {};

TEST_P(EventfulScenes, ComeBackAndStayFinite) {
  for (int i = 0; i < samples(10); ++i) expectSoundWhateverHappens(1 + static_cast<std::uint64_t>(10 * GetParam() + i));
}
INSTANTIATE_TEST_SUITE_P(Groups, EventfulScenes, ::testing::Range(0, 8));

class LiveScenes : public ::testing::TestWithParam<int> {};

TEST_P(LiveScenes, ComeBackAndGoOnAsTheirTwins) {
  for (int i = 0; i < samples(10); ++i) expectSoundWhateverHappens(1 + static_cast<std::uint64_t>(10 * GetParam() + i), EVENTFUL, true);
}
INSTANTIATE_TEST_SUITE_P(Groups, LiveScenes, ::testing::Range(0, 6));

/** Seeds that failed once. */
class EventfulScenesFound : public ::testing::TestWithParam<int> {};

TEST_P(EventfulScenesFound, AreSound) { expectSoundWhateverHappens(static_cast<std::uint64_t>(GetParam())); }
// A model that came, or went, just before the state was saved; a slider that hits a stone; links in tension; a model that came while
// another one bounced; a contact that turned round.
INSTANTIATE_TEST_SUITE_P(Seeds, EventfulScenesFound, ::testing::Values(672, 676, 715, 1372, 3527, 12865, 20178));

}  // namespace
}  // namespace blem_sim::sim
