#include "sending/publish_schedule.h"

#include <gtest/gtest.h>

namespace blem_sim::node {
namespace {

int countDue(double rate, double time_step, int steps) {
  PublishSchedule schedule(rate);
  int due = 0;
  for (int step = 1; step <= steps; ++step) due += schedule.due(step * time_step) ? 1 : 0;
  return due;
}

TEST(PublishSchedule, ZeroIsEveryStep) { EXPECT_EQ(countDue(0, 0.001, 1000), 1000); }

TEST(PublishSchedule, BelowZeroIsNever) { EXPECT_EQ(countDue(-1, 0.001, 1000), 0); }

TEST(PublishSchedule, HoldsTheRateWhateverTheStep) {
  // The first step is due as well, in the period of time 0.
  EXPECT_EQ(countDue(100, 0.001, 10000), 1001);
  EXPECT_EQ(countDue(30, 0.001, 10000), 301);
  EXPECT_EQ(countDue(30, 0.0007, 100000), 2101);
  EXPECT_EQ(countDue(50, 0.002, 5000), 501);
}

TEST(PublishSchedule, IsDueAtMultiplesOfThePeriod) {
  PublishSchedule schedule(100);
  EXPECT_TRUE(schedule.due(0));
  for (int step = 1; step <= 5000; ++step) EXPECT_EQ(schedule.due(step * 0.001), step % 10 == 0) << step;
}

TEST(PublishSchedule, NeverFasterThanTheSteps) { EXPECT_EQ(countDue(5000, 0.001, 100), 100); }

TEST(PublishSchedule, StartsAgain) {
  PublishSchedule schedule(10);
  EXPECT_TRUE(schedule.due(0));
  EXPECT_FALSE(schedule.due(0.01));
  schedule.restart();
  EXPECT_TRUE(schedule.due(0.01));
}

}  // namespace
}  // namespace blem_sim::node
