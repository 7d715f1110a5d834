#include "loop/step_pacer.h"

#include <gtest/gtest.h>

namespace blem_sim::node {
namespace {

using Clock = StepPacer::Clock;
using std::chrono::microseconds;
using std::chrono::milliseconds;

/** Number of steps that are due at once at `now`, each taking no time. */
int stepsDue(StepPacer* pacer, Clock::time_point now) {
  int steps = 0;
  while (pacer->wait(now) <= 0 && steps < 100000) {
    pacer->stepped(now);
    ++steps;
  }
  return steps;
}

TEST(StepPacer, KeepsTheFactor) {
  const Clock::time_point start = Clock::now();
  StepPacer pacer(2.0, 0.001);
  pacer.restart(start);
  // A pacer that wakes every 0.7 ms owes a step per 0.5 ms.
  int steps = 0;
  for (int wake = 0; wake <= 1000; ++wake) steps += stepsDue(&pacer, start + wake * microseconds(700));
  EXPECT_EQ(steps, 1401);
}

TEST(StepPacer, WaitsForTheNextStep) {
  const Clock::time_point start = Clock::now();
  StepPacer pacer(0.5, 0.001);
  pacer.restart(start);
  EXPECT_EQ(pacer.wait(start), 0);
  pacer.stepped(start);
  EXPECT_NEAR(pacer.wait(start), 0.002, 1e-9);
  EXPECT_NEAR(pacer.wait(start + microseconds(1500)), 0.0005, 1e-9);
  EXPECT_EQ(pacer.wait(start + milliseconds(3)), 0);
}

TEST(StepPacer, SleepsUntilTheNextStepUnlessItWaitsBusily) {
  const Clock::time_point start = Clock::now();
  for (const bool is_busy : {false, true}) {
    StepPacer pacer(1.0, 0.001, is_busy);
    pacer.restart(start);
    pacer.stepped(start);
    EXPECT_NEAR(pacer.wait(start), 0.001, 1e-9);
    EXPECT_NEAR(pacer.sleep(start), is_busy ? 0 : 0.001, 1e-9);
  }
}

TEST(StepPacer, NoBurstAfterAStall) {
  const Clock::time_point start = Clock::now();
  StepPacer pacer(1.0, 0.001);
  pacer.restart(start);
  pacer.stepped(start);
  const int steps = stepsDue(&pacer, start + milliseconds(5000));
  EXPECT_LE(steps, 1 + static_cast<int>(StepPacer::MAX_BACKLOG / 0.001) + 1);
  EXPECT_GE(steps, 2);
}

TEST(StepPacer, CatchesUpASmallDelay) {
  const Clock::time_point start = Clock::now();
  StepPacer pacer(1.0, 0.001);
  pacer.restart(start);
  pacer.stepped(start);
  EXPECT_EQ(stepsDue(&pacer, start + milliseconds(10)), 10);
}

TEST(StepPacer, ZeroIsAsFastAsPossible) {
  const Clock::time_point start = Clock::now();
  StepPacer pacer(0.0, 0.001);
  pacer.restart(start);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(pacer.wait(start), 0);
    pacer.stepped(start);
  }
}

}  // namespace
}  // namespace blem_sim::node
