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
  const WorldState saved = hubo.world().save();
  const int steps = soakSteps(1, 0.2);
  const std::uint64_t first = hashAfter(&hubo, steps);
  hubo.world().restore(saved);
  EXPECT_EQ(hashAfter(&hubo, steps), first);
  HuboStand other(falling());
  other.world().restore(saved);
  EXPECT_EQ(hashAfter(&other, steps), first);
  std::printf("hash after the impact: %016" PRIx64 "\n", first);
}

}  // namespace
}  // namespace blem_sim
