// Messages of steps go out in order, and have gone out when drain() returns. Without it the sender's thread wakes by itself in time.
#include "sending/step_sender.h"

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include <chrono>
#include <ctime>
#include <mutex>
#include <numeric>
#include <thread>

#include "messages/message_pool.h"

namespace blem_sim::node {
namespace {

using Clock = StepSender::Clock;
using std::chrono::milliseconds;

/** A topic of numbers. */
class Numbers {
 public:
  explicit Numbers(milliseconds takes = milliseconds(0)) : takes_(takes) {}
  void publish(const boost::shared_ptr<int>& number) {
    if (takes_.count() > 0) std::this_thread::sleep_for(takes_);
    const std::lock_guard<std::mutex> lock(mutex_);
    published_.push_back(*number);
  }
  std::vector<int> published() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return published_;
  }
  /** Waits for `count` messages. False if they are not that many within 20 s. */
  bool waitFor(std::size_t count) const {
    const Clock::time_point deadline = Clock::now() + std::chrono::seconds(20);
    while (published().size() < count && Clock::now() < deadline) std::this_thread::sleep_for(milliseconds(1));
    return published().size() == count;
  }

 private:
  milliseconds takes_;
  mutable std::mutex mutex_;
  std::vector<int> published_;
};

std::vector<int> upTo(int count) {
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

TEST(StepSender, PublishesInOrderAndNothingBeforeItIsSent) {
  Numbers topic;
  StepSender sender;
  for (int i = 0; i < 1000; ++i) {
    sender.add(&topic, boost::make_shared<int>(i));
    if (i % 10 == 9) sender.send();
  }
  sender.drain();
  EXPECT_EQ(topic.published(), upTo(1000));
  sender.add(&topic, boost::make_shared<int>(0));
  sender.drain();
  EXPECT_EQ(topic.published().size(), 1000u);
}

TEST(StepSender, DrainWaitsForTheBatchUnderWay) {
  Numbers topic(milliseconds(50));
  StepSender sender;
  sender.add(&topic, boost::make_shared<int>(7));
  sender.send();
  std::this_thread::sleep_for(milliseconds(10));  // the thread has taken it
  sender.drain();
  EXPECT_EQ(topic.published(), std::vector<int>{7});
}

TEST(StepSender, EndsAfterTheLastMessage) {
  Numbers topic;
  {
    StepSender sender;
    for (int i = 0; i < 100; ++i) {
      sender.add(&topic, boost::make_shared<int>(i));
      sender.send();
    }
  }
  EXPECT_EQ(topic.published(), upTo(100));
}

TEST(StepSender, StepsInTimeLateAndAtOnceArriveCompleteWithoutDraining) {
  Numbers topic;
  StepSender sender;
  int sent = 0;
  const auto step = [&] {
    for (int i = 0; i < 5; ++i) sender.add(&topic, boost::make_shared<int>(sent++));
    sender.send();
  };
  Clock::time_point due = Clock::now();
  for (int i = 0; i < 300; ++i) {
    step();
    if (i % 50 > 40) continue;                               // a burst
    if (i % 50 == 40) due = Clock::now() + milliseconds(8);  // the thread has given up napping
    std::this_thread::sleep_until(due += milliseconds(1));
  }
  EXPECT_TRUE(topic.waitFor(sent));
  EXPECT_EQ(topic.published(), upTo(sent));
}

TEST(StepSender, SleepsOnceNoStepComesAndIsWokenByTheNext) {
  Numbers topic;
  StepSender sender;
  for (int i = 0; i < 20; ++i) {
    sender.add(&topic, boost::make_shared<int>(i));
    sender.send();
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_TRUE(topic.waitFor(20));
  const std::clock_t start = std::clock();  // processor time
  std::this_thread::sleep_for(milliseconds(400));
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 0.02);
  sender.add(&topic, boost::make_shared<int>(20));
  sender.send();
  EXPECT_TRUE(topic.waitFor(21));
}

/** A sender's thread naps: for a second after the only hand-over so far, which came a second after the start. */
class NappingSender : public testing::Test {
 protected:
  NappingSender() {
    std::this_thread::sleep_for(milliseconds(1000));
    send(0);
    sender_.drain();
    nap_ends_ = Clock::now() + milliseconds(900);
    std::this_thread::sleep_for(milliseconds(50));
  }
  void send(int number) {
    sender_.add(&topic_, boost::make_shared<int>(number));
    sender_.send();
  }

  Numbers topic_;
  StepSender sender_{std::chrono::seconds(10)};
  Clock::time_point nap_ends_;  // at the soonest
};

TEST_F(NappingSender, IsNotWokenByOneHandOverButByTheNext) {
  send(1);
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(topic_.published(), upTo(1));
  send(2);
  EXPECT_TRUE(topic_.waitFor(3));
  EXPECT_LT(Clock::now(), nap_ends_);
  EXPECT_EQ(topic_.published(), upTo(3));
}

TEST_F(NappingSender, IsWokenByADrain) {
  send(1);
  sender_.drain();
  EXPECT_EQ(topic_.published(), upTo(2));
  EXPECT_LT(Clock::now(), nap_ends_);
}

TEST_F(NappingSender, LooksByItself) {
  send(1);
  EXPECT_TRUE(topic_.waitFor(2));
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
}  // namespace blem_sim::node
