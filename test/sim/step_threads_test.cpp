// Number of threads that share a step.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>

#include "threads/step_threads.h"

namespace blem_sim::sim {
namespace {

int threadsAtWork(StepThreads* threads, std::size_t contacts) {
  threads->expect(contacts);
  return threads->with([] { return tbb::this_task_arena::max_concurrency(); });
}

int atMost(int count) { return std::min(count, tbb::this_task_arena::max_concurrency()); }

TEST(StepThreads, AreTwoInCrowdedStepsUnlessANumberIsAskedFor) {
  StepThreads chosen(std::nullopt), one(1), three(3);
  EXPECT_EQ(threadsAtWork(&chosen, dynamics::CROWDED - 1), 1);
  EXPECT_EQ(threadsAtWork(&chosen, dynamics::CROWDED), atMost(2));
  EXPECT_EQ(threadsAtWork(&chosen, 0), 1);
  EXPECT_EQ(threadsAtWork(&one, dynamics::CROWDED), 1);
  EXPECT_EQ(threadsAtWork(&three, 0), atMost(3));
}

// Workspaces are made for the most there may be: a thread beyond them would write where nobody has room.
TEST(StepThreads, NumberThemselvesBelowTheMost) {
  StepThreads threads(std::nullopt);
  threads.expect(dynamics::CROWDED);
  EXPECT_FALSE(threads.anyOf(10000, 1, [&](std::size_t) { return tbb::this_task_arena::current_thread_index() >= threads.most(); }));
}

}  // namespace
}  // namespace blem_sim::sim
