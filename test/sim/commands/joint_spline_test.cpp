// Analytic checks of one joint's spline: polynomials, their derivatives, splicing as joint_trajectory_controller does it.
#include <gtest/gtest.h>

#include <cmath>

#include "blem_sim/sim/trajectory.h"

namespace blem_sim::sim {
namespace {

using Knot = JointSpline::Knot;

Knot linear(double time, double position) { return {time, position, 0, 0, 0, 1}; }
Knot cubic(double time, double position, double velocity) { return {time, position, velocity, 0, 0, 3}; }
Knot quintic(double time, double position, double velocity, double acceleration) { return {time, position, velocity, acceleration, 0, 5}; }

void expectSample(const JointSample& sample, double position, double velocity, double acceleration, double tolerance) {
  EXPECT_NEAR(sample.position, position, tolerance);
  EXPECT_NEAR(sample.velocity, velocity, tolerance);
  EXPECT_NEAR(sample.acceleration, acceleration, tolerance);
}

TEST(JointSpline, HoldsWithoutACommand) {
  expectSample(JointSpline().sample(3), 0, 0, 0, 0);
  const JointSpline spline(1.5);
  for (const double time : {-1.0, 0.0, 7.0}) expectSample(spline.sample(time), 1.5, 0, 0, 0);
}

TEST(JointSpline, PositionsAloneAreLinear) {
  JointSpline spline(1);
  spline.splice(2, 2, {linear(3, 2), linear(5, -2)}, false);
  expectSample(spline.sample(2.5), 1.5, 1, 0, 1e-15);
  expectSample(spline.sample(4), 0, -2, 0, 1e-15);
  expectSample(spline.sample(5), -2, -2, 0, 1e-15);
  expectSample(spline.sample(5.001), -2, 0, 0, 0);
  EXPECT_EQ(spline.endTime(), 5);
}

TEST(JointSpline, ReproducesACubic) {
  const auto p = [](double t) { return 1 - 2 * t + 3 * t * t - 0.5 * t * t * t; };
  const auto v = [](double t) { return -2 + 6 * t - 1.5 * t * t; };
  const auto a = [](double t) { return 6 - 3 * t; };
  JointSpline spline(0);
  spline.splice(0, 0, {cubic(1, p(1), v(1)), cubic(2.5, p(2.5), v(2.5)), cubic(4, p(4), v(4))}, false);
  for (double t = 1; t < 4; t += 0.01) {
    SCOPED_TRACE(t);
    expectSample(spline.sample(t), p(t), v(t), a(t), 1e-12);
  }
}

TEST(JointSpline, ReproducesAQuintic) {
  const auto p = [](double t) { return 0.3 + t - t * t + 2 * std::pow(t, 3) - 0.7 * std::pow(t, 4) + 0.1 * std::pow(t, 5); };
  const auto v = [](double t) { return 1 - 2 * t + 6 * t * t - 2.8 * std::pow(t, 3) + 0.5 * std::pow(t, 4); };
  const auto a = [](double t) { return -2 + 12 * t - 8.4 * t * t + 2 * std::pow(t, 3); };
  JointSpline spline(0);
  spline.splice(0, 0, {quintic(1, p(1), v(1), a(1)), quintic(1.75, p(1.75), v(1.75), a(1.75)), quintic(3, p(3), v(3), a(3))}, false);
  for (double t = 1; t < 3; t += 0.01) {
    SCOPED_TRACE(t);
    expectSample(spline.sample(t), p(t), v(t), a(t), 1e-10);
  }
}

/** Largest jumps of position, velocity, acceleration across a time. */
JointSample jump(const JointSpline& spline, double time) {
  const JointSample before = spline.sample(std::nextafter(time, -1e9)), after = spline.sample(time);
  return {std::abs(after.position - before.position), std::abs(after.velocity - before.velocity),
          std::abs(after.acceleration - before.acceleration), 0};
}

TEST(JointSpline, DerivativesAreContinuousWhereTheOrderAllows) {
  JointSpline with_velocities(0.2), with_accelerations(0.2);
  with_velocities.splice(0, 0, {cubic(1, 1, 0.7), cubic(1.5, 0, -3), cubic(4, 2, 0)}, false);
  with_accelerations.splice(0, 0, {quintic(1, 1, 0.7, 3), quintic(1.5, 0, -3, -1), quintic(4, 2, 0, 0)}, false);
  for (const double time : {1.0, 1.5}) {
    EXPECT_LT(jump(with_velocities, time).position, 1e-12);
    EXPECT_LT(jump(with_velocities, time).velocity, 1e-12);
    EXPECT_GT(jump(with_velocities, time).acceleration, 1e-3) << "a cubic is not that smooth; the test would see nothing";
    EXPECT_LT(jump(with_accelerations, time).velocity, 1e-11);
    EXPECT_LT(jump(with_accelerations, time).acceleration, 1e-10);
  }
}

TEST(JointSpline, DerivativesAreThoseOfThePosition) {
  JointSpline spline(0.2);
  spline.splice(0, 0, {cubic(1, 1, 0.7), quintic(2, 0, -3, 1), linear(3, 2)}, false);
  const double h = 1e-5;
  for (double t = 0.05; t < 3; t += 0.1) {
    const double p0 = spline.sample(t - h).position, p1 = spline.sample(t).position, p2 = spline.sample(t + h).position;
    EXPECT_NEAR(spline.sample(t).velocity, (p2 - p0) / (2 * h), 1e-7);
    EXPECT_NEAR(spline.sample(t).acceleration, (p2 - 2 * p1 + p0) / (h * h), 1e-3);
  }
}

TEST(JointSpline, BetweenPointsOfDifferentOrderTheLowerCounts) {
  JointSpline spline(0);
  spline.splice(0, 0, {linear(1, 1), cubic(2, 3, 9)}, false);
  expectSample(spline.sample(1.5), 2, 2, 0, 1e-15);
}

TEST(JointSpline, PointsInThePastAreDropped) {
  JointSpline spline(5);
  spline.splice(10, 8, {linear(8, -100), linear(9, -50), linear(10, -20), linear(12, 7)}, false);
  expectSample(spline.sample(10), 5, 1, 0, 1e-15);
  expectSample(spline.sample(11), 6, 1, 0, 1e-15);
  spline.splice(11, 1, {linear(2, 0), linear(3, 0)}, false);
  expectSample(spline.sample(11.5), 6.5, 1, 0, 1e-15);
}

TEST(JointSpline, PointsBeforeAStartToComeAreDropped) {
  JointSpline spline(5);
  spline.splice(10, 12, {linear(11, -100), linear(11.9, -50), linear(13, 7)}, false);
  expectSample(spline.sample(11.5), 5, 0, 0, 0);
  expectSample(spline.sample(12.5), 6, 2, 0, 1e-15);
  spline.splice(12.5, 20, {linear(14, -100), linear(15, -50)}, false);
  expectSample(spline.sample(12.75), 6.5, 2, 0, 1e-15);
}

TEST(JointSpline, TheOldOneRunsUntilTheNewOneStarts) {
  JointSpline old(0), spliced(0);
  const std::vector<Knot> first = {cubic(1, 1, 2), cubic(3, -1, 0), quintic(6, 4, 0, 0)};
  old.splice(0, 0, first, false);
  spliced.splice(0, 0, first, false);
  spliced.splice(0.5, 2, {cubic(5, 10, 0)}, false);
  for (double t = 0.5; t < 2; t += 0.01) {
    const JointSample expected = old.sample(t);
    SCOPED_TRACE(t);
    expectSample(spliced.sample(t), expected.position, expected.velocity, expected.acceleration, 1e-12);
  }
  EXPECT_LT(jump(spliced, 2).position, 1e-12);
  EXPECT_LT(jump(spliced, 2).velocity, 1e-12);
  expectSample(spliced.sample(6), 10, 0, 0, 1e-12);
  EXPECT_EQ(spliced.endTime(), 5);
}

TEST(JointSpline, AfterTheEndTheOldOneIsHeldUntilTheStart) {
  JointSpline spline(0);
  spline.splice(0, 0, {linear(1, 2)}, false);
  spline.splice(3, 5, {linear(6, 4)}, false);
  expectSample(spline.sample(4), 2, 0, 0, 0);
  expectSample(spline.sample(5.5), 3, 2, 0, 1e-15);
}

TEST(JointSpline, AFirstPointAtTheStartIsAJump) {
  JointSpline spline(0);
  spline.splice(0, 1, {linear(1, 5), linear(2, 6)}, false);
  expectSample(spline.sample(0.9), 0, 0, 0, 0);
  expectSample(spline.sample(1), 5, 1, 0, 1e-15);
  JointSpline point(0);
  point.splice(0, 1, {linear(1, 5)}, false);
  expectSample(point.sample(0.9), 0, 0, 0, 0);
  expectSample(point.sample(1), 5, 0, 0, 0);
}

TEST(JointSpline, NoPointsHoldWhereItIs) {
  JointSpline spline(0);
  spline.splice(0, 0, {linear(2, 2)}, false);
  spline.splice(1, 0, {}, false);
  expectSample(spline.sample(1.7), 1, 0, 0, 1e-15);
}

TEST(JointSpline, ContinuousJointsTakeTheNearestTurn) {
  const double turn = 2 * M_PI;
  JointSpline spline(3 * turn + 0.1);
  spline.splice(0, 0, {linear(1, -0.2), linear(2, 3)}, true);
  EXPECT_NEAR(spline.sample(1).position, 3 * turn - 0.2, 1e-12);
  EXPECT_NEAR(spline.sample(2).position, 3 * turn + 3, 1e-12) << "later points keep their distance from the first";
  JointSpline limited(3 * turn + 0.1);
  limited.splice(0, 0, {linear(1, -0.2)}, false);
  EXPECT_NEAR(limited.sample(1).position, -0.2, 1e-12);
}

TEST(JointSpline, HalfATurnGoesTheWayOfTheNumbers) {
  const auto endOf = [](double from, double to) {
    JointSpline spline(from);
    spline.splice(0, 0, {linear(1, to)}, true);
    return spline.sample(1).position;
  };
  EXPECT_NEAR(endOf(-M_PI / 2, M_PI / 2), M_PI / 2, 1e-12);
  EXPECT_NEAR(endOf(M_PI / 2, -M_PI / 2), -M_PI / 2, 1e-12);
  EXPECT_NEAR(endOf(0, M_PI), M_PI, 1e-12);
  EXPECT_NEAR(endOf(0, -M_PI), -M_PI, 1e-12);
  EXPECT_NEAR(endOf(0, 3 * M_PI), M_PI, 1e-12);
  EXPECT_NEAR(endOf(7, 7 - 5 * M_PI), 7 - M_PI, 1e-12);
  EXPECT_NEAR(endOf(0, M_PI + 1e-6), -M_PI + 1e-6, 1e-12);
}

TEST(JointSpline, EffortIsInterpolatedAndHeld) {
  JointSpline spline(0);
  spline.splice(0, 0, {{1, 0, 0, 0, 4, 1}, {2, 0, 0, 0, 8, 1}}, false);
  EXPECT_DOUBLE_EQ(spline.sample(0.5).effort, 2);
  EXPECT_DOUBLE_EQ(spline.sample(1.5).effort, 6);
  EXPECT_DOUBLE_EQ(spline.sample(9).effort, 8);
}

TEST(JointSpline, SavedAndReadItIsTheSame) {
  JointSpline first(0.3), second(0);
  first.splice(0.1, 0.1, {cubic(1, 1, 2), quintic(3, -1, 0.1, 0.7)}, false);
  geometry::StateContent saved;
  geometry::StateWriter writer(&saved);
  first.save(&writer);
  second.save(&writer);
  geometry::StateReader reader(saved);
  JointSpline read_first, read_second(7);
  read_first.restore(&reader);
  read_second.restore(&reader);
  EXPECT_EQ(reader.numbersLeft(), 0u);
  for (double t = 0; t < 4; t += 0.037) {
    EXPECT_EQ(read_first.sample(t).position, first.sample(t).position);
    EXPECT_EQ(read_first.sample(t).acceleration, first.sample(t).acceleration);
    EXPECT_EQ(read_second.sample(t).position, 0);
  }
}

}  // namespace
}  // namespace blem_sim::sim
