// Targets of scripts/fuzz on their seeds and on bytes near these, without clang.
#include <map>

#include "fuzz/seeds.h"
#include "fuzz/sim_targets.h"

namespace blem_sim::sim {
namespace {

const std::map<std::string, FuzzTarget> TARGETS = {{"yaml", fuzzYaml}, {"csv", fuzzCsv}, {"state", fuzzState}, {"input", fuzzInput}};

class SimFuzzSeeds : public testing::TestWithParam<std::string> {};

TEST_P(SimFuzzSeeds, AreReadOrRefusedInOneLine) { runSeeds(GetParam(), TARGETS.at(GetParam())); }

INSTANTIATE_TEST_SUITE_P(Targets, SimFuzzSeeds, testing::Values("yaml", "csv", "state", "input"),
                         [](const auto& target) { return target.param; });

}  // namespace
}  // namespace blem_sim::sim
