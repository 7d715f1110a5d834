#include <gtest/gtest.h>

#include "blem_sim/sim/trajectory.h"
#include "support/input_errors.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"

namespace blem_sim::sim {
namespace {

const std::vector<std::string> COLUMNS = {"hip", "knee", "knee_vel"};

class TrajectoryCsv : public testing::Test {
 protected:
  JointTrajectory load(const std::string& text) { return loadTrajectoryCsv(folder_.write("motion.csv", text), COLUMNS, &ignored_); }
  std::string refusalOf(const std::string& text) {
    return refusal([&] { load(text); });
  }
  TemporaryFolder folder_;
  std::vector<std::string> ignored_;
};

TEST_F(TrajectoryCsv, ReadsTimesAndPositions) {
  const JointTrajectory trajectory = load("# a motion\nroot_x,time,knee,hip,\n\n1,0,0.5,-1e-3,\r\n# half way\n2, 0.25 ,0.75,\"2\",\n");
  EXPECT_EQ(trajectory.joints, (std::vector<std::string>{"knee", "hip"}));
  ASSERT_EQ(trajectory.points.size(), 2u);
  EXPECT_EQ(trajectory.points[0].positions, (std::vector<double>{0.5, -1e-3}));
  EXPECT_EQ(trajectory.points[1].time_from_start, 0.25);
  EXPECT_EQ(trajectory.points[1].positions, (std::vector<double>{0.75, 2}));
  EXPECT_TRUE(trajectory.points[1].velocities.empty());
  EXPECT_EQ(ignored_, (std::vector<std::string>{"root_x", ""}));
}

TEST_F(TrajectoryCsv, ReadsVelocities) {
  const JointTrajectory trajectory = load("time,hip,hip_vel\n0,1,2\n1,3,4\n");
  EXPECT_EQ(trajectory.joints, std::vector<std::string>{"hip"});
  EXPECT_EQ(trajectory.points[1].velocities, std::vector<double>{4});
  EXPECT_TRUE(ignored_.empty());
}

TEST_F(TrajectoryCsv, ReadsWhatSpreadsheetsWrite) {
  EXPECT_EQ(load("\xef\xbb\xbftime,hip\r\n0,1\r\n").points[0].positions, std::vector<double>{1});
}

TEST_F(TrajectoryCsv, AJointThatIsNamedLikeAVelocityIsAJoint) {
  const JointTrajectory trajectory = load("time,knee,knee_vel\n0,1,2\n");
  EXPECT_EQ(trajectory.joints, (std::vector<std::string>{"knee", "knee_vel"}));
  EXPECT_EQ(trajectory.points[0].positions, (std::vector<double>{1, 2}));
}

TEST_F(TrajectoryCsv, RefusesInOneLine) {
  const auto expect = [this](const std::string& text, std::initializer_list<std::string> words) {
    const std::string said = refusalOf(text);
    EXPECT_TRUE(isOneLineWith(said, words)) << said;
  };
  expect("", {"motion.csv", "no rows"});
  expect("time,hip\n", {"motion.csv", "no rows"});
  expect("milestone,hip\n0,1\n", {"no column 'time'", "'milestone'"});
  expect("time,hip,hip\n0,1,1\n", {"'hip'", "twice"});
  expect("time,hop\n0,1\n", {"'hop'", "'hip'"});
  expect("time,hip\n0,1,2\n", {"motion.csv:2", "3 values for 2 columns"});
  expect("time,hip\n0\n", {"motion.csv:2", "1 values"});
  expect("time,hip\n0,1\n1,nan\n", {"motion.csv:3", "'nan'"});
  expect("time,hip\n0,1\n1,inf\n", {"motion.csv:3", "'inf'"});
  expect("time,hip\n0,1\n1,1.5x\n", {"motion.csv:3", "'1.5x'"});
  expect("time,hip\n0,\n", {"motion.csv:2", "''"});
  expect("time,hip\n0,1\n0,2\n", {"motion.csv", "increase"});
  expect("time,hip,knee,hip_vel\n0,1,2,3\n", {"1 columns of velocities for 2 joints"});
  expect("time,knee,hip_vel\n0,1,2\n", {"1 columns of velocities for 1 joints"});
  const std::string missing = refusal([&] { loadTrajectoryCsv(folder_.path("none.csv"), COLUMNS, nullptr); });
  EXPECT_TRUE(isOneLineWith(missing, {"none.csv", "cannot be read"})) << missing;
}

TEST_F(TrajectoryCsv, ReadsTheSharedSway) {
  SKIP_WITHOUT_SHARED_DATA("motions/hubo_sway_path_opt.csv");
  const JointTrajectory sway =
      loadTrajectoryCsv(*sharedData("motions/hubo_sway_path_opt.csv"), {"Body_LKP_joint", "Body_RKP_joint", "Body_Hip_joint"}, &ignored_);
  EXPECT_EQ(sway.points.size(), 579u);
  EXPECT_EQ(sway.joints.size(), 3u);
  EXPECT_EQ(ignored_.size(), 6u + 54u);
  EXPECT_EQ(ignored_[0], "root_x");
}

}  // namespace
}  // namespace blem_sim::sim
