// blem_sim_run: the world of a YAML file, without ROS.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "options.h"
#include "run.h"
#include "run_batch.h"

using blem_sim::ExitStatus;

int main(int argc, char** argv) {
  try {
    const blem_sim::RunOptions options = blem_sim::parseOptions(std::vector<std::string>(argv + 1, argv + argc));
    if (options.help) {
      std::fputs(blem_sim::RUN_USAGE, stdout);
      return ExitStatus::FINISHED;
    }
    if (options.version) {
      std::puts("blem_sim " BLEM_SIM_VERSION);
      return ExitStatus::FINISHED;
    }
    if (!options.batch.empty()) return blem_sim::runBatch(options);
    return blem_sim::run(options, nullptr) == blem_sim::RunEnd::NOT_FINITE ? ExitStatus::NOT_FINITE : ExitStatus::FINISHED;
  } catch (const blem_sim::InputError& error) {
    std::fprintf(stderr, "blem_sim_run: %s\n", error.what());
    return ExitStatus::BAD_INPUT;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "blem_sim_run: %s\n", error.what());
    return ExitStatus::FAILED;
  }
}
