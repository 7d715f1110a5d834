// Targets of scripts/fuzz on their seeds and on bytes near these, without clang.
#include <gtest/gtest.h>

#include "fuzz/ros_targets.h"
#include "fuzz/seeds.h"

namespace blem_sim::node {
namespace {

TEST(RosFuzzSeeds, PointsAreReadOrRefusedInOneLine) { runSeeds("points", fuzzPoints); }
TEST(RosFuzzSeeds, PointsAreJoinedOrRefusedInOneLine) { runSeeds("joined", fuzzJoined); }
TEST(RosFuzzSeeds, TrianglesAreReadOrRefusedInOneLine) { runSeeds("triangles", fuzzTriangles); }
TEST(RosFuzzSeeds, GridsAreReadOrRefusedInOneLine) { runSeeds("grid", fuzzGrid); }

}  // namespace
}  // namespace blem_sim::node
