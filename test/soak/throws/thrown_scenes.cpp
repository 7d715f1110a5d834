// Random scenes of test/support/throw_scene.h: bodies that passed, meshes that crossed, and those that were not said.
#include <cstdlib>
#include <cstring>
#include <exception>

#include "support/throw_scene.h"

namespace blem_sim {
namespace {

struct Options {
  std::uint64_t first = 1, count = 10000;
  bool verbose = false;
};

struct Counts {
  int scenes = 0, crossed = 0, passed = 0, said = 0, unsaid = 0, untold = 0, easy = 0, easy_crossed = 0, easy_passed = 0, refused = 0,
      most_solves = 0;
};

/** Whether a scene has steps of at most 1 ms, default widths and nothing faster than 20 m/s: there the step guard must keep all apart. */
bool isEasy(const ThrownScene& scene, const ThrownOutcome& outcome) {
  return scene.default_widths && scene.config.time_step <= 0.001 && outcome.fastest <= 20;
}

void add(std::uint64_t seed, bool verbose, Counts* counts) {
  const ThrownScene scene = thrownScene(seed);
  const ThrownOutcome outcome = runThrownScene(scene);
  const bool easy = isEasy(scene, outcome);
  ++counts->scenes;
  counts->crossed += outcome.crossed;
  counts->passed += outcome.passed;
  counts->said += outcome.said;
  counts->unsaid += outcome.unsaid;
  counts->untold += outcome.untold;
  counts->easy += easy;
  counts->easy_crossed += easy && outcome.crossed;
  counts->easy_passed += easy && outcome.passed;
  counts->most_solves = std::max(counts->most_solves, outcome.most_solves);
  if (verbose || outcome.unsaid || outcome.untold || (easy && outcome.crossed))
    std::printf("seed %-6llu%s%s%s%s%s%s | %s | %d steps, at most %d solves, fastest %.3g m/s\n", static_cast<unsigned long long>(seed),
                outcome.unsaid ? " UNSAID" : "", outcome.untold ? " UNTOLD" : "", outcome.passed ? " passed" : "",
                outcome.crossed ? " crossed" : "", outcome.said ? " said" : "", easy ? " easy" : "", scene.description.c_str(),
                outcome.steps, outcome.most_solves, outcome.fastest);
  std::fflush(stdout);
}

int runAll(const Options& options) {
  Counts counts;
  for (std::uint64_t i = 0; i < options.count; ++i) {
    try {
      add(options.first + i, options.verbose, &counts);
    } catch (const std::exception& error) {
      ++counts.refused;
      std::printf("seed %llu refused: %s\n", static_cast<unsigned long long>(options.first + i), error.what());
    }
  }
  std::printf("%d scenes: %d crossed, of these %d passed; bit set in %d; UNSAID %d, UNTOLD %d, refused %d; at most %d solves a step\n",
              counts.scenes, counts.crossed, counts.passed, counts.said, counts.unsaid, counts.untold, counts.refused, counts.most_solves);
  std::printf("%d of them at most 1 ms, default widths and 20 m/s: %d crossed, of these %d passed\n", counts.easy, counts.easy_crossed,
              counts.easy_passed);
  return counts.unsaid + counts.untold + counts.refused + counts.easy_passed > 0 ? 1 : 0;
}

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  blem_sim::Options options;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--verbose") == 0) options.verbose = true;
    if (i + 1 == argc) continue;
    if (std::strcmp(argv[i], "--first") == 0)
      options.first = std::strtoull(argv[++i], nullptr, 10);
    else if (std::strcmp(argv[i], "--count") == 0)
      options.count = std::strtoull(argv[++i], nullptr, 10);
  }
  return blem_sim::runAll(options);
}
