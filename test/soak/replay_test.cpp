// The same bits again: saved in the middle of an impact and restored, in the same world and in another.
#include <gtest/gtest.h>

#include <cinttypes>

#include "soak/figures.h"
#include "soak/hubo_stand.h"
#include "soak/world_figures.h"

namespace blem_sim {
namespace {

HuboOptions falling() {
  HuboOptions options;
  options.settings = soakSettings();
  options.drop = 0.05;
  options.margin = 5e-3;
  return options;
}

std::uint64_t hashAfter(HuboStand* hubo, int steps) {
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(hubo->step().finite) << i;
  return hashOf(hubo->world().save());
}

TEST(Replay, RestoredInTheMiddleOfAnImpact) {
  SKIP_WITHOUT_SHARED_DATA(HUBO_FOLDER);
  HuboStand hubo(falling());
  double force = 0;
  for (int i = 0; i < 500 && force < hubo.weight(); ++i) force = hubo.groundForce(hubo.step());
  ASSERT_GT(force, hubo.weight());
  figure("impact: ground force over m g when saved", force / hubo.weight(), "");
  const dynamics::WorldState saved = hubo.world().save();
  const int steps = soakSteps(1, 0.2);
  const std::uint64_t first = hashAfter(&hubo, steps);
  hubo.world().restore(saved);
  EXPECT_EQ(hashAfter(&hubo, steps), first);
  HuboStand other(falling());
  other.world().restore(saved);
  EXPECT_EQ(hashAfter(&other, steps), first);
  std::printf("hash after the impact: %016" PRIx64 "\n", first);
}

/** Sets the number of threads; false where the solver has no such setting. */
template <typename Settings>
auto setThreads(Settings* settings, int threads, int) -> decltype(settings->threads = threads, true) {
  settings->threads = threads;
  return true;
}
template <typename Settings>
bool setThreads(Settings*, int, long) {
  return false;
}

/** Twelve pairs of cubes that fall onto each other. */
std::uint64_t hashOfPairs(const dynamics::SolverSettings& settings) {
  const Vector3 size(0.1, 0.1, 0.1);
  dynamics::World world(Vector3(0, 0, -9.81), settings);
  for (int i = 0; i < 24; ++i) world.addBody(dynamics::boxBody("cube", 1 + i, size, {0.5 * (i / 2), 0.001 * i, 0.1 + 0.15 * (i % 2)}));
  for (int k = 0; k < soakSteps(2, 0.5); ++k) {
    std::vector<dynamics::ContactConstraint> contacts;
    for (int i = 0; i < 24; i += 2) {
      dynamics::boxOnPlane(world, i, size, Vector3::UnitZ(), 0, {}, &contacts, 5e-3);
      dynamics::boxOnBox(world, i + 1, size, i, size, {}, &contacts);
    }
    EXPECT_TRUE(world.step(1e-3, contacts, {}).finite) << k;
  }
  return hashOf(world.save());
}

TEST(Replay, AnyNumberOfThreads) {
  dynamics::SolverSettings settings = soakSettings();
  if (!setThreads(&settings, 1, 0)) GTEST_SKIP() << "SolverSettings has no number of threads: islands are solved one after the other";
  const std::uint64_t one = hashOfPairs(settings);
  for (const int threads : {2, 4}) {
    setThreads(&settings, threads, 0);
    EXPECT_EQ(hashOfPairs(settings), one) << threads;
  }
}

}  // namespace
}  // namespace blem_sim
