// blem_sim_run: the world of a YAML file, without ROS.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "options.h"
#include "run.h"

namespace {

enum ExitStatus { FINISHED = 0, FAILED = 1, BAD_INPUT = 2, NOT_FINITE = 3 };

}  // namespace

int main(int argc, char** argv) {
  try {
    const blem_sim::RunOptions options = blem_sim::parseOptions(std::vector<std::string>(argv + 1, argv + argc));
    if (options.help) {
      std::fputs(blem_sim::RUN_USAGE, stdout);
      return FINISHED;
    }
    if (options.version) {
      std::puts("blem_sim " BLEM_SIM_VERSION);
      return FINISHED;
    }
    return blem_sim::run(options) ? FINISHED : NOT_FINITE;
  } catch (const blem_sim::InputError& error) {
    std::fprintf(stderr, "blem_sim_run: %s\n", error.what());
    return BAD_INPUT;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "blem_sim_run: %s\n", error.what());
    return FAILED;
  }
}
