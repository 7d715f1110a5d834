// Slips that answer linearly to those of the proximal point are found from three steps; plain repetition takes as long as the map is slow.
#include "lanes/slip_mixing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace blem_sim::dynamics {
namespace {

/** Four contacts over a plane, whose slips are a linear map of De Saxce's terms with rates 0.7 and -0.4. */
class LinearSlips : public ::testing::Test {
 protected:
  LinearSlips() {
    for (int lane = 0; lane < LANES; ++lane) {
      block_.normal[2][lane] = 1;
      block_.velocity[2][lane] = 0.3;
      block_.kind[lane] = ContactBlock::SLIP;
    }
    answer();
  }

  /** Answer of a solve: velocities that follow from the slips of the proximal point. */
  void answer() {
    const double sum = block_.slip[0] + block_.slip[1], difference = block_.slip[0] - block_.slip[1];
    const double next_sum = SUM + 0.7 * (sum - SUM), next_difference = DIFFERENCE - 0.4 * (difference - DIFFERENCE);
    block_.velocity[0][0] = 0.5 * (next_sum + next_difference);
    block_.velocity[1][1] = -0.5 * (next_sum - next_difference);
  }

  double miss() const {
    return std::max(std::abs(block_.slip[0] + block_.slip[1] - SUM), std::abs(block_.slip[0] - block_.slip[1] - DIFFERENCE));
  }

  static constexpr double SUM = 0.5, DIFFERENCE = 0.1;  // [m/s] where the map stays
  ContactBlock block_{};
  SlipMixing mixing_;
};

TEST_F(LinearSlips, AreFoundFromThreeSteps) {
  mixing_.start(LANES);
  for (int step = 0; step < 2; ++step) {
    mixing_.remember(&block_, &block_ + 1);
    EXPECT_GT(miss(), 1e-6) << step;
    answer();
  }
  mixing_.remember(&block_, &block_ + 1);
  EXPECT_LT(miss(), 1e-12);
  for (int i = 0; i < 3; ++i) {  // a fixed point stays
    answer();
    mixing_.remember(&block_, &block_ + 1);
    EXPECT_LT(miss(), 1e-12);
  }
}

TEST_F(LinearSlips, OfAnotherProblemAreForgotten) {
  for (int step = 0; step < 3; ++step) {
    mixing_.start(LANES);
    mixing_.remember(&block_, &block_ + 1);
    EXPECT_EQ(block_.slip[0], std::abs(block_.velocity[0][0]));
    EXPECT_EQ(block_.slip[1], std::abs(block_.velocity[1][1]));
    answer();
  }
}

TEST_F(LinearSlips, OfOpenContactsAreTheirOwn) {
  block_.kind[2] = ContactBlock::OPEN;
  mixing_.start(LANES);
  for (int step = 0; step < 4; ++step) {
    block_.velocity[0][2] = 1.0 / (1 + step);
    mixing_.remember(&block_, &block_ + 1);
    EXPECT_EQ(block_.slip[2], 1.0 / (1 + step));
    answer();
  }
  EXPECT_LT(miss(), 1e-12);
}

TEST_F(LinearSlips, ImpulsesBecomeTheProximalPointsOwn) {
  block_.impulse[1][3] = 2;
  mixing_.start(LANES);
  for (int step = 0; step < 2; ++step) mixing_.remember(&block_, &block_ + 1);
  EXPECT_EQ(block_.previous[1][3], 2);
}

}  // namespace
}  // namespace blem_sim::dynamics
