// Plays a record again. Exit codes: 0 the same hashes, 1 a step differs, 2 bad input.
#include <cinttypes>
#include <cstdio>
#include <exception>

#include "saving/replay.h"

int main(int argc, char** argv) {
  if (argc != 2 || argv[1][0] == '-') {
    std::fprintf(stderr, "usage: rosrun blem_sim replay FILE.bag   (of rosrun blem_sim record, or the parameter record)\n");
    return 2;
  }
  try {
    const blem_sim::node::ReplayResult replay = blem_sim::node::replay(argv[1]);
    if (!replay.difference.empty()) {
      std::printf("%s: %s\n", argv[1], replay.difference.c_str());
      return 1;
    }
    std::printf("%s: the same in all %" PRIu64 " steps, with %" PRIu64 " inputs; state hash %016" PRIx64 "\n", argv[1], replay.steps,
                replay.inputs, replay.hash);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "replay: %s\n", error.what());
    return 2;
  }
  return 0;
}
