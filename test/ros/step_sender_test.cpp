// Messages of steps go out in order, and have gone out when they are waited for.
#include "step_sender.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>

#include "message_pool.h"

namespace blem_sim {
namespace {

TEST(StepSender, PublishesInOrderAndNothingBeforeItIsSent) {
  StepSender sender;
  std::vector<int> published;
  for (int i = 0; i < 1000; ++i) {
    sender.add([&published, i] { published.push_back(i); });
    if (i % 10 == 9) sender.send();
  }
  sender.drain();
  ASSERT_EQ(published.size(), 1000u);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(published[i], i);
  sender.add([&published] { published.push_back(0); });
  sender.drain();
  EXPECT_EQ(published.size(), 1000u);
}

TEST(StepSender, DrainWaitsForTheBatchUnderWay) {
  StepSender sender;
  std::atomic<bool> published{false};
  sender.add([&published] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    published = true;
  });
  sender.send();
  std::this_thread::sleep_for(std::chrono::milliseconds(10));  // the thread has taken it
  sender.drain();
  EXPECT_TRUE(published);
}

TEST(StepSender, EndsAfterTheLastMessage) {
  std::atomic<int> published{0};
  {
    StepSender sender;
    for (int i = 0; i < 100; ++i) {
      sender.add([&published] { ++published; });
      sender.send();
    }
  }
  EXPECT_EQ(published, 100);
}

TEST(MessagePool, GivesOnlyMessagesThatNobodyHolds) {
  MessagePool<std::vector<int>> pool({1, 2});
  auto first = pool.spare();
  EXPECT_EQ(*first, (std::vector<int>{1, 2}));
  first->push_back(3);
  const auto second = pool.spare();
  EXPECT_NE(first, second);
  EXPECT_EQ(*second, (std::vector<int>{1, 2}));
  const std::vector<int>* place = first.get();
  first.reset();
  const auto third = pool.spare();
  EXPECT_EQ(third.get(), place);
  EXPECT_EQ(third->size(), 3u);
}

}  // namespace
}  // namespace blem_sim
