// Balls that rain on files of the shared data do not get through; scripts/validate_throws --rain takes all files.
#include <gtest/gtest.h>

#include "support/rain/rain.h"
#include "support/sanitizers.h"
#include "support/shared_data.h"

namespace blem_sim::sim {
namespace {

class Rain : public testing::TestWithParam<const char*> {};

TEST_P(Rain, staysOnTheFile) {
  SKIP_WITHOUT_SHARED_DATA(GetParam());
  const RainOutcome outcome = rainOn(*sharedData(GetParam()), SANITIZED ? 0.05 : 1, 2);
  EXPECT_GE(outcome.balls, 24);
  if (!SANITIZED) {
    EXPECT_GT(outcome.touched, outcome.balls / 3);
  }
  EXPECT_TRUE(outcome.finite);
  EXPECT_EQ(outcome.crossed, 0) << outcome.first_crossing;
  EXPECT_LT(outcome.max_of_layer, 1);
}

INSTANTIATE_TEST_SUITE_P(Files, Rain,
                         testing::Values("pathological/cube_cracked_soup.stl", "pathological/cube_nested_self_intersecting.ply",
                                         "meshes/klampt/object_srimugsmooth.stl", "scans/real/floor3_bleach.ply",
                                         "scans/synthetic_kinect/chair_model.ply"),
                         [](const testing::TestParamInfo<const char*>& info) { return std::to_string(info.index); });

/** A test of the test: balls that nothing holds are seen to go through. */
TEST(Rain, seesWhatGoesThrough) {
  SimulationConfig config;
  config.environments = {ground()};
  config.gravity.setZero();
  const std::vector<rain::Ball> balls = {{0.02, true, {0, 0, 0.1}, 0}, {0.02, false, {0.2, 0, 0.1}, 0}};
  for (std::size_t i = 0; i < balls.size(); ++i) config.objects.push_back(rain::objectOf(balls[i], rain::Ways::nameOf(i)));
  Simulator simulator(config, model::UriResolver());
  ElementGrid grid(simulator.colliders()[colliderOf(simulator, "ground")].geometry->mesh());
  rain::Ways ways(simulator, balls, &grid);
  RainOutcome outcome;
  ways.look(&outcome);
  EXPECT_EQ(outcome.crossed, 0);
  for (int i = 0; i < 2; ++i) {
    dynamics::BodyState below;
    below.X_WB = makePose({0.2 * i, 0, -0.1});
    simulator.moveModel(simulator.models()[simulator.modelIndex(rain::Ways::nameOf(i))].bodies[0], below);
  }
  ways.look(&outcome);
  EXPECT_EQ(outcome.crossed, 2);
  ways.look(&outcome);
  EXPECT_EQ(outcome.untold, 2);
}

}  // namespace
}  // namespace blem_sim::sim
