#include "trees/team.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <thread>
#include <vector>

namespace blem_sim::dynamics {
namespace {

template <typename Work>
void withHelper(Team* team, const Work& work) {
  tbb::task_arena(2).execute([&] { team->with(1, work); });
}

TEST(Team, TakesEachChunkOnce) {
  Team team;
  withHelper(&team, [&] {
    for (int count = 0; count < 2000; ++count) {
      std::vector<int> taken(count, 0);
      team.forChunks(count, [&](int chunk) { ++taken[chunk]; });
      ASSERT_EQ(taken, std::vector<int>(count, 1));
    }
  });
}

TEST(Team, SharesALoop) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one processor";
  Team team;
  withHelper(&team, [&] {
    std::atomic<int> inside{0};
    // Each of the two waits until the other has come: one thread alone would never end.
    team.forChunks(2, [&](int) {
      ++inside;
      while (inside < 2) std::this_thread::yield();
    });
    EXPECT_EQ(inside, 2);
  });
}

TEST(Team, WorksAloneWithoutHelpers) {
  Team team;
  std::vector<std::thread::id> threads(100);
  team.with(0, [&] { team.forChunks(100, [&](int chunk) { threads[chunk] = std::this_thread::get_id(); }); });
  EXPECT_EQ(threads, std::vector<std::thread::id>(100, std::this_thread::get_id()));
}

TEST(Team, WorksWhereNoThreadIsFree) {
  Team team;
  int sum = 0;
  tbb::task_arena(1).execute([&] { team.with(3, [&] { team.forChunks(100, [&](int chunk) { sum += chunk; }); }); });
  EXPECT_EQ(sum, 4950);
}

TEST(Team, CutsRangesIntoPieces) {
  Team team;
  std::vector<std::pair<std::size_t, std::size_t>> pieces;
  team.forRanges(3, 10, 3, [&](std::size_t first, std::size_t end) { pieces.emplace_back(first, end); });
  team.forRanges(3, 3, 3, [&](std::size_t first, std::size_t end) { pieces.emplace_back(first, end); });
  EXPECT_EQ(pieces, (std::vector<std::pair<std::size_t, std::size_t>>{{3, 6}, {6, 9}, {9, 10}}));
}

TEST(Team, WorksAgainAfterItWasDismissed) {
  Team team;
  for (int round = 0; round < 50; ++round) {
    std::atomic<int> sum{0};
    withHelper(&team, [&] {
      for (int loop = 0; loop < 20; ++loop) team.forChunks(7, [&](int chunk) { sum += chunk; });
    });
    ASSERT_EQ(sum, 20 * 21);
  }
}

}  // namespace
}  // namespace blem_sim::dynamics
