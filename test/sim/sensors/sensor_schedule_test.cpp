#include "sensors/readings/sensor_schedule.h"

#include <gtest/gtest.h>

namespace blem_sim::sim {
namespace {

int readings(const SensorSchedule& schedule, std::uint64_t first, std::uint64_t end) {
  int count = 0;
  for (std::uint64_t step = first; step < end; ++step) count += schedule.due(step);
  return count;
}

TEST(SensorSchedule, RateHoldsOnAverageWhateverTheStep) {
  for (const double rate : {1.0, 7.0, 60.0, 300.0, 333.0, 999.0, 1000.0})
    for (const double dt : {0.001, 0.0005, 0.0001}) {
      const SensorSchedule schedule(rate, dt);
      const auto steps = static_cast<std::uint64_t>(std::llround(20 / dt));
      EXPECT_EQ(readings(schedule, 1, steps + 1), 20 * rate) << rate << " Hz, " << dt << " s";
      EXPECT_NEAR(schedule.period() * rate, 1, 1e-12);
    }
}

TEST(SensorSchedule, ReadingsAreEvenlyApart) {
  const SensorSchedule schedule(300, 0.001);
  std::uint64_t last = 0;
  for (std::uint64_t step = 1; step <= 10000; ++step) {
    if (!schedule.due(step)) continue;
    EXPECT_TRUE(step - last == 3 || step - last == 4) << step;
    last = step;
  }
}

TEST(SensorSchedule, WholePeriodsAreExactForYears) {
  for (const std::uint64_t start : {std::uint64_t{0}, std::uint64_t{3000000000}, std::uint64_t{1000000000000}}) {
    const SensorSchedule schedule(200, 0.001);
    for (std::uint64_t step = start + 1; step <= start + 100; ++step) EXPECT_EQ(schedule.due(step), step % 5 == 0) << step;
  }
}

TEST(SensorSchedule, RoundingDelaysNoReading) {
  // 0.29 * 100 is below 29 in doubles.
  EXPECT_TRUE(SensorSchedule(290, 0.001).due(100));
  EXPECT_EQ(readings(SensorSchedule(290, 0.001), 1, 101), 29);
}

TEST(SensorSchedule, NeverBelowZero) { EXPECT_EQ(readings(SensorSchedule(-1, 0.001), 1, 1001), 0); }

TEST(SensorSchedule, EveryStepWithoutARateOrWithOneThatIsFasterThanTheSteps) {
  for (const double rate : {0.0, 1000.0, 1500.0, 1e9}) {
    const SensorSchedule schedule(rate, 0.001);
    EXPECT_EQ(readings(schedule, 1, 1001), 1000) << rate;
    EXPECT_EQ(schedule.period(), 0.001) << rate;
  }
}

}  // namespace
}  // namespace blem_sim::sim
