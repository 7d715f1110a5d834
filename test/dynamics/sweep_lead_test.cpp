// Sweeps that are led on, of which each changes numbers as a visit of contacts would.
#include "sweeps/sweep_lead.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

constexpr double RATES[2] = {0.01, 0.5};  // by which a sweep brings numbers nearer to nothing

/** Sweeps until both numbers are below 1e-6 of their beginning. @return their number */
int sweepsToNothing(bool led) {
  SweepLead lead;
  lead.start(0);
  lead.beginRun();
  double numbers[2] = {1, -1};
  double before[2] = {};
  int sweeps = 0;
  for (; std::max(std::abs(numbers[0]), std::abs(numbers[1])) > 1e-6; ++sweeps) {
    double change = 0;
    lead.move(numbers, numbers + 2, before);
    for (int i = 0; i < 2; ++i) {
      change += std::pow(RATES[i] * numbers[i], 2);
      numbers[i] -= RATES[i] * numbers[i];
    }
    if (led) lead.take(change);
  }
  return sweeps;
}

TEST(SweepLead, NeedsAFractionOfTheSweeps) {
  const int plain = sweepsToNothing(false);
  EXPECT_NEAR(plain, std::log(1e-6) / std::log(1 - RATES[0]), 2);
  EXPECT_LT(sweepsToNothing(true), plain / 4);
}

TEST(SweepLead, FirstSweepOfARunMovesNothing) {
  SweepLead lead;
  double number = 1, before = 0;
  lead.beginRun();
  lead.move(&number, &number + 1, &before);
  EXPECT_EQ(number, 1);
  number = 0.5;
  lead.take(0.25);
  lead.move(&number, &number + 1, &before);
  EXPECT_EQ(number, 0.5 - lead.share() * 0.5) << "moved on by a share of the change";
  EXPECT_GT(lead.share(), 0);
  EXPECT_EQ(before, 0.5);
  lead.beginRun();
  const double last = number;
  lead.move(&number, &number + 1, &before);
  EXPECT_EQ(number, last);
}

TEST(SweepLead, StandsStillOnceChangesGrow) {
  SweepLead lead;
  double number = 1, before = 0;
  lead.beginRun();
  for (const double change : {0.01, 0.01, 0.01}) {
    lead.move(&number, &number + 1, &before);
    number -= 0.1;
    lead.take(change);
  }
  EXPECT_GT(lead.share(), 0);
  lead.take(0.02);
  const double last = number;
  lead.move(&number, &number + 1, &before);
  EXPECT_EQ(number, last);
}

TEST(SweepLead, MovesVelocitiesAsItMovesNumbers) {
  SweepLead lead;
  lead.start(3);
  lead.beginRun();
  double velocities[3] = {1, 2, 3}, number = 2, before = 0;
  for (int sweep = 0; sweep < 5; ++sweep) {
    lead.moveVelocities(1, 3, velocities);
    lead.move(&number, &number + 1, &before);
    EXPECT_EQ(velocities[1], number);
    EXPECT_EQ(velocities[0], 1) << "outside of the range";
    velocities[1] *= 0.9;
    number *= 0.9;
    lead.take(0.1);
  }
}

}  // namespace
}  // namespace blem_sim::dynamics
