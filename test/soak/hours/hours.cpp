// Hours of one simulation, a row of figures every so often: memory, cost of a step, energy, status.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <string>

#include "blem_sim/sim/simulator.h"

namespace blem_sim {
namespace {

/** [s] of this process. */
double processorSeconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/** [kB] resident now. */
long residentMemory() {
  long all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

/** Steps of a row, and what they were like. */
struct Row {
  std::uint32_t status = 0;
  double deepest = 0;  // of the layers
  double seconds = 0;  // of processor time

  void add(const sim::StepReport& report) {
    status |= report.status;
    deepest = std::max(deepest, report.max_of_layer);
  }
};

/** A row's steps; stops where the state is not finite. */
Row makeSteps(sim::Simulator* simulator, std::uint64_t steps) {
  Row row;
  const double start = processorSeconds();
  for (std::uint64_t i = 0; i < steps && (row.status & sim::STATE_NOT_FINITE) == 0; ++i) row.add(simulator->step());
  row.seconds = processorSeconds() - start;
  return row;
}

/** @return 0: all states were finite */
int run(const std::string& config, double hours, double row_seconds) {
  sim::Simulator simulator(sim::loadConfigFile(config), model::UriResolver());
  const auto steps = static_cast<std::uint64_t>(row_seconds / simulator.config().time_step + 0.5);
  std::printf("time_s,step_us,resident_kB,energy_J,status,deepest_of_layer\n");
  while (simulator.time() < 3600 * hours) {
    const Row row = makeSteps(&simulator, steps);
    std::printf("%.0f,%.3f,%ld,%.9g,%u,%.4f\n", simulator.time(), 1e6 * row.seconds / static_cast<double>(steps), residentMemory(),
                simulator.report().energy, row.status, row.deepest);
    std::fflush(stdout);
    if ((row.status & sim::STATE_NOT_FINITE) != 0) return 3;
  }
  return 0;
}

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: soak_hours CONFIG.yaml HOURS [SECONDS_OF_A_ROW]\n");
    return 2;
  }
  try {
    return blem_sim::run(argv[1], std::atof(argv[2]), argc > 3 ? std::atof(argv[3]) : 60);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
