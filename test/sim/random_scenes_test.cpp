// Three hundred random scenes; scripts/validate_random_scenes runs thousands, or one of them alone.
#include <gtest/gtest.h>

#include "support/random_scene_run.h"
#include "support/sanitizers.h"

namespace blem_sim {
namespace {

const int GROUPS = 20, SCENES_OF_GROUP = samples(15);
constexpr double START = 0.15;                 // [s] of each of three hundred: all of them in less than a minute
constexpr double FOUND = SANITIZED ? 0.1 : 1;  // [s] of each seed that failed once

void expectSound(std::uint64_t seed, double duration) {
  SceneOutcome outcome;
  runRandomScene(seed, duration, &outcome);
  EXPECT_FALSE(outcome.failed()) << outcome.failure << ": " << outcome.details << "\n"
                                 << randomScene(seed).description << "\nscripts/validate_random_scenes --seed " << seed;
}

class RandomScenes : public ::testing::TestWithParam<int> {};

TEST_P(RandomScenes, StayFiniteAndGainNoEnergyUntold) {
  for (int i = 0; i < SCENES_OF_GROUP; ++i) expectSound(1 + static_cast<std::uint64_t>(GetParam() * SCENES_OF_GROUP + i), START);
}
INSTANTIATE_TEST_SUITE_P(Groups, RandomScenes, ::testing::Range(0, GROUPS));

/** Seeds that failed once, each for its second. */
class RandomScenesFound : public ::testing::TestWithParam<int> {};

TEST_P(RandomScenesFound, AreSound) { expectSound(static_cast<std::uint64_t>(GetParam()), FOUND); }
INSTANTIATE_TEST_SUITE_P(Seeds, RandomScenesFound, ::testing::Values(28, 52, 61, 74, 103, 163, 180, 236, 265, 5694, 8854));

}  // namespace
}  // namespace blem_sim
