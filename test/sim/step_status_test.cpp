#include "blem_sim/sim/step_status.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace blem_sim::sim {
namespace {

TEST(StepStatus, BitsStandInTheirOrder) {
  for (std::size_t i = 0; i < std::size(STEP_STATUS); ++i) EXPECT_EQ(STEP_STATUS[i].bit, 1u << i) << STEP_STATUS[i].name;
  EXPECT_EQ(1u << 7, ENERGY_GAINED);
  EXPECT_STREQ(STEP_STATUS[7].name, "ENERGY_GAINED");
  EXPECT_EQ(1u << 8, MOTION_TOO_FAST);
  EXPECT_STREQ(STEP_STATUS[8].name, "MOTION_TOO_FAST");
}

TEST(StepStatus, MessageRepeatsTheTable) {
  std::ifstream message(BLEM_SIM_SOURCE_DIR "/msg/StepReport.msg");
  ASSERT_TRUE(message);
  const std::regex constant(R"(uint32 (\w+) = (\d+) *# (.*))");
  std::size_t row = 0;
  for (std::string line; std::getline(message, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, constant)) continue;
    ASSERT_LT(row, std::size(STEP_STATUS)) << line;
    const StatusBit& status = STEP_STATUS[row++];
    EXPECT_EQ(match[1], status.name);
    EXPECT_EQ(match[2], std::to_string(status.bit));
    EXPECT_EQ(match[3], std::string(status.meaning) + (*status.cure ? ": " : "") + status.cure);
  }
  EXPECT_EQ(row, std::size(STEP_STATUS));
}

}  // namespace
}  // namespace blem_sim::sim
