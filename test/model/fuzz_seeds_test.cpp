// Targets of scripts/fuzz on their seeds and on bytes near these, without clang.
#include <map>
#include <stdexcept>

#include "fuzz/model_targets.h"
#include "fuzz/seeds.h"

namespace blem_sim::model {
namespace {

const std::map<std::string, FuzzTarget> TARGETS = {{"urdf", fuzzUrdf}, {"stl", fuzzStl}, {"ply", fuzzPly},
                                                   {"obj", fuzzObj},   {"off", fuzzOff}, {"pcd", fuzzPcd}};

class ModelFuzzSeeds : public testing::TestWithParam<std::string> {};

TEST_P(ModelFuzzSeeds, AreReadOrRefusedInOneLine) { runSeeds(GetParam(), TARGETS.at(GetParam())); }

INSTANTIATE_TEST_SUITE_P(Targets, ModelFuzzSeeds, testing::Values("urdf", "stl", "ply", "obj", "off", "pcd"),
                         [](const auto& target) { return target.param; });

TEST(FuzzTargets, AnErrorOfAnotherKindIsAFinding) {
  EXPECT_DEATH(expectReadOrRefused([] { throw std::length_error("lie"); }), "finding: .*lie");
  EXPECT_DEATH(expectReadOrRefused([] { throw InputError("two\nlines"); }), "not one line");
  expectReadOrRefused([] { throw InputError("one line"); });
}

}  // namespace
}  // namespace blem_sim::model
