// Pairs searched at once.
#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

SimulationConfig heap(int threads) {
  SimulationConfig config;
  config.solver.threads = threads;
  config.environments = {ground()};
  for (int i = 0; i < 12; ++i) {
    config.objects.push_back(box("box" + std::to_string(i), {0.1, 0.08, 0.06}, 1, {0.06 * (i % 3), 0.07 * (i % 2), 0.05 + 0.08 * i}));
    config.objects.back().X_WO = config.objects.back().X_WO * makePose(Vector3::Zero(), {0.1 * i, 0.2, 0.3 * i});
  }
  return config;
}

TEST(PairSearches, AnyNumberOfThreadsGivesTheSameBits) {
  Simulator one(heap(1), model::UriResolver()), three(heap(3), model::UriResolver());
  stepFor(&one, 0.6);
  stepFor(&three, 0.6);
  EXPECT_GT(one.report().contacts.size(), 5u);
  EXPECT_EQ(one.stateHash(), three.stateHash());
}

// Memories of searches are no part of it.
TEST(PairSearches, AStateRestoredElsewhereGoesOnTheSame) {
  Simulator first(heap(1), model::UriResolver()), second(heap(1), model::UriResolver());
  stepFor(&first, 0.4);
  second.restore(first.save());
  stepFor(&first, 0.2);
  stepFor(&second, 0.2);
  EXPECT_EQ(first.stateHash(), second.stateHash());
}

}  // namespace
}  // namespace blem_sim::sim
