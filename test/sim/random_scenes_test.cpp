// Three hundred random scenes; scripts/validate_random_scenes runs thousands, or one of them alone.
#include <gtest/gtest.h>

#include "support/random_scene_run.h"

namespace blem_sim {
namespace {

constexpr int GROUPS = 20, SCENES_OF_GROUP = 15;

class RandomScenes : public ::testing::TestWithParam<int> {};

TEST_P(RandomScenes, StayFiniteAndGainNoEnergyUntold) {
  for (int i = 0; i < SCENES_OF_GROUP; ++i) {
    const std::uint64_t seed = 1 + static_cast<std::uint64_t>(GetParam() * SCENES_OF_GROUP + i);
    SceneOutcome outcome;
    runRandomScene(seed, 1, &outcome);
    EXPECT_FALSE(outcome.failed()) << outcome.failure << ": " << outcome.details << "\n"
                                   << randomScene(seed).description << "\nscripts/validate_random_scenes --seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Groups, RandomScenes, ::testing::Range(0, GROUPS));

}  // namespace
}  // namespace blem_sim
