#include "blem_sim/model/voxel_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace blem_sim::model {
namespace {

VoxelMapOptions options() {
  VoxelMapOptions options;
  options.voxel = 0.01;
  return options;
}

TEST(VoxelMap, countsCloudsNotPoints) {
  VoxelMapOptions two_hits = options();
  two_hits.min_hits = 2;
  VoxelMap map(two_hits);
  map.add({{0.001, 0.001, 0.001}, {0.003, 0.001, 0.001}}, 0);
  EXPECT_EQ(map.size(), 1u);
  EXPECT_TRUE(map.points().empty());
  map.add({{0.005, 0.001, 0.001}, {0.095, 0, 0}}, 0.1);
  ASSERT_EQ(map.points().size(), 1u);
  EXPECT_NEAR(map.points()[0].x(), 0.5 * (0.002 + 0.005), 1e-12);
}

TEST(VoxelMap, averagesNoiseAndFollowsASurface) {
  VoxelMap map(options());
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.001);
  for (int i = 0; i < 400; ++i) map.add({{0.005, 0.005, 0.005 + noise(random)}}, 0.1 * i);
  ASSERT_EQ(map.points().size(), 1u);
  EXPECT_NEAR(map.points()[0].z(), 0.005, 0.0003);
  for (int i = 0; i < 400; ++i) map.add({{0.005, 0.005, 0.008}}, 40 + 0.1 * i);
  EXPECT_NEAR(map.points()[0].z(), 0.008, 0.0001);
}

TEST(VoxelMap, cubesBelowZeroAreOthers) {
  VoxelMap map(options());
  map.add({{0.001, 0, 0}, {-0.001, 0, 0}, {0, -0.001, 0}, {0, 0, -0.001}}, 0);
  EXPECT_EQ(map.size(), 4u);
}

TEST(VoxelMap, forgetsWhatIsOldByTheLatestTime) {
  VoxelMapOptions short_lived = options();
  short_lived.expire_after = 1;
  VoxelMap map(short_lived);
  map.add({{0, 0, 0}}, 0);
  map.add({{1, 0, 0}}, 0.9);
  EXPECT_EQ(map.size(), 2u);
  map.add({{1, 0, 0}}, 0.5);  // a clock that goes back
  EXPECT_EQ(map.size(), 2u);
  map.add({{2, 0, 0}}, 1.5);
  EXPECT_EQ(map.size(), 2u);
  EXPECT_EQ(map.points()[0].x(), 1);
}

TEST(VoxelMap, isBounded) {
  VoxelMapOptions small = options();
  small.max_voxels = 100;
  VoxelMap map(small);
  for (int i = 0; i < 50; ++i) {
    std::vector<Vector3> points;
    for (int j = 0; j < 10; ++j) points.emplace_back(0.01 * (10 * i + j) + 0.005, 0, 0);
    map.add(points, i);
    ASSERT_LE(map.size(), 100u);
  }
  const std::vector<Vector3> newest = map.points();
  ASSERT_EQ(newest.size(), 100u);
  EXPECT_NEAR(newest.front().x(), 4.005, 1e-9);
  EXPECT_NEAR(newest.back().x(), 4.995, 1e-9);
}

TEST(VoxelMap, leavesOutWhatItCannotNumber) {
  VoxelMap map(options());
  map.add({{1e6, 0, 0}, {0, NAN, 0}, {0, 0, -INFINITY}, {1, 1, 1}}, 0);
  EXPECT_EQ(map.size(), 1u);
}

TEST(VoxelMap, isTheSameForTheSameClouds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.2, 0.2);
  VoxelMap a(options()), b(options());
  for (int i = 0; i < 5; ++i) {
    std::vector<Vector3> points;
    for (int j = 0; j < 1000; ++j) points.emplace_back(place(random), place(random), place(random));
    a.add(points, i);
    b.add(points, i);
  }
  EXPECT_EQ(a.points(), b.points());
}

}  // namespace
}  // namespace blem_sim::model
