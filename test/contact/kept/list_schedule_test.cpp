// Rules of the schedule of candidate lists, by tables of figures worked out by hand.
#include "kept/list_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace blem_sim::contact {
namespace {

/** A pair within 10 mm, 1000 candidates of 100 pairs of leaves listed with 2 mm of margin, that gain 100 per mm. */
ListFigures plannedFigures(double motion, double turn = 0) {
  ListFigures now;
  now.known = true;
  now.range = 0.01;
  now.motion = motion;
  now.turn = turn;
  now.growth = 1e5;
  now.leaf_pairs = 100;
  now.candidates = 1000;
  now.margin = 0.002;
  return now;
}
ListFigures ungrownFigures(double motion, std::size_t leaf_pairs = 100) {
  ListFigures now = plannedFigures(motion);
  now.growth = 0;
  now.leaf_pairs = leaf_pairs;
  return now;
}

// 100 pairs of leaves and the 800 candidates that there are without a margin cost 10,400 looks.
TEST(ListSchedule, CheapestStepsWeighMakingAgainstLooking) {
  struct Row {
    double motion, steps;
  };
  for (const Row& row : {Row{0, 50}, Row{1e-5, 50}, Row{1e-3, 20.396078}, Row{4e-3, 10.198039}, Row{1, 3}})
    EXPECT_NEAR(ListSchedule::cheapestSteps(plannedFigures(row.motion)), row.steps, 1e-6) << row.motion;
}

TEST(ListSchedule, MarginsOfContactLists) {
  struct Row {
    std::string what;
    ListFigures now;
    double part, motion, turn;  // margin in mm, and of directions
  };
  ListFigures unknown;
  unknown.range = 0.01;
  const Row rows[] = {
      {"motion not known: a tenth of the range", unknown, 1, 1, 0.05},
      {"growth not known: 15 steps", ungrownFigures(1e-4), 1, 1.5, 0.005},
      {"a part of them", ungrownFigures(1e-4), 0.8, 1.2, 0.005},
      {"0.8 of the range at most", ungrownFigures(1e-3), 1, 8, 0.005},
      {"0.3 of it with many pairs of leaves", ungrownFigures(1e-3, 4001), 1, 3, 0.005},
      {"0.02 of it at least", ungrownFigures(1e-6), 1, 0.2, 0.005},
      {"growth known: the cheapest steps, turning for as long", plannedFigures(1e-3, 0.001), 1, 20.396078, 0.020396078},
      {"2.2 of the range at most", plannedFigures(4e-3), 1, 22, 0.005},
  };
  for (const Row& row : rows) {
    const ListMargin margin = ListSchedule::contactMargin(row.now, row.part);
    EXPECT_NEAR(1e3 * margin.motion, row.motion, 1e-6) << row.what;
    EXPECT_NEAR(margin.turn, row.turn, 1e-6) << row.what;
  }
}

TEST(ListSchedule, FastPairsAndManyLeaves) {
  EXPECT_FALSE(ListSchedule::isFast(plannedFigures(0.00266)));
  EXPECT_TRUE(ListSchedule::isFast(plannedFigures(0.00267)));
  EXPECT_FALSE(ListSchedule::areMany(ungrownFigures(0, 4000)));
  EXPECT_TRUE(ListSchedule::areMany(ungrownFigures(0, 4001)));
  EXPECT_DOUBLE_EQ(ListSchedule::crossingSteps(plannedFigures(1e-4)), 10);
  EXPECT_DOUBLE_EQ(ListSchedule::crossingSteps(plannedFigures(2e-3)), 4);
  EXPECT_DOUBLE_EQ(ListSchedule::crossingSteps(ungrownFigures(2e-3, 4001)), 1.5);
}

TEST(ListSchedule, NextListsAreBegunFiveStepsBeforeTheyAreNeeded) {
  struct Row {
    double before, used;
    bool ends;
  };
  for (const Row& row : {Row{0.5, 0.5, false}, Row{0.6, 0.5, false}, Row{0.80, 0.83, false}, Row{0.80, 0.84, true}, Row{0, 0.2, true}})
    EXPECT_EQ(ListSchedule::endsSoon(row.before, row.used), row.ends) << row.before << " " << row.used;
  EXPECT_TRUE(ListSchedule::lasts(0.0051, plannedFigures(0.001)));
  EXPECT_FALSE(ListSchedule::lasts(0.0049, plannedFigures(0.001)));
  for (const std::size_t pairs : {1, 4, 65, 67}) {
    std::size_t left = pairs, steps = 0;
    for (; left > 0; ++steps) left -= std::min(left, ListSchedule::partOfPairs(pairs));
    EXPECT_LE(steps, ListSchedule::PARTS) << pairs;
  }
}

TEST(ListSchedule, PosesAhead) {
  EXPECT_DOUBLE_EQ(ListSchedule::stepsAhead(0.002, plannedFigures(0)), 0);
  EXPECT_DOUBLE_EQ(ListSchedule::stepsAhead(0.002, plannedFigures(2e-4)), 9);
  EXPECT_DOUBLE_EQ(ListSchedule::stepsAhead(0.002, plannedFigures(1e-6)), 16);
  const ListMargin nearer = ListSchedule::marginAhead({0.002, 0.01, 0.002 * Matrix3::Identity()});
  EXPECT_DOUBLE_EQ(nearer.motion, 0.00196);
  EXPECT_DOUBLE_EQ(nearer.turn, 0.0098);
  EXPECT_DOUBLE_EQ(nearer.ways(1, 1), 0.00196);
}

TEST(ListSchedule, StepsAndMarginsOfTheNearest) {
  struct Row {
    ListFigures now;
    double steps, motion;  // margin in mm
  };
  ListFigures long_list = plannedFigures(1e-4);
  long_list.margin = 0.01;
  // 500 looks against 10 more tests a step: 7.07 steps; 0.4 of the list's margin at most; 2 at least.
  for (const Row& row : {Row{ungrownFigures(1e-4), 3, 0.3}, Row{long_list, 7.0710678, 0.70710678}, Row{plannedFigures(2e-4), 4, 0.8},
                         Row{plannedFigures(1e-3), 2, 2}, Row{plannedFigures(1e-6), 8, 0.05}}) {
    EXPECT_NEAR(ListSchedule::nearestSteps(row.now), row.steps, 1e-6);
    EXPECT_NEAR(1e3 * ListSchedule::nearestMargin(row.now).motion, row.motion, 1e-6);
    EXPECT_DOUBLE_EQ(ListSchedule::nearestMargin(row.now).turn, 0.001);
  }
}

TEST(ListSchedule, ChoicesAreWorthTheirWhile) {
  ListFigures now = plannedFigures(1e-4);
  EXPECT_TRUE(ListSchedule::isWorthChoosing(0.0009, now));
  EXPECT_FALSE(ListSchedule::isWorthChoosing(0.001, now));
  now.candidates = 50;
  EXPECT_FALSE(ListSchedule::isWorthChoosing(0.0009, now));
  now.candidates = 150;
  EXPECT_DOUBLE_EQ(ListSchedule::growth(50, 0.001, now), 100 / 0.001);
  EXPECT_DOUBLE_EQ(ListSchedule::growth(150, 0.001, now), 1 / 0.001);
}

// A part of the steps that differs from pose to pose.
TEST(ListSchedule, PairsThatSetOutTogetherListInDifferentSteps) {
  double least = 2, most = 0;
  for (int i = 0; i < 100; ++i) {
    const double part = ListSchedule::partOf(makePose({1.2345e-4 * i, 0, 0}));
    least = std::min(least, part);
    most = std::max(most, part);
  }
  EXPECT_GE(least, 0.7);
  EXPECT_LE(most, 1);
  EXPECT_GT(most - least, 0.2);
}

}  // namespace
}  // namespace blem_sim::contact
