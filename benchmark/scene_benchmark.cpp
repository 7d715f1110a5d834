// Whole steps of whole scenes: everything but publishing. Processor time of the stepping thread per step; the stages' means are wall time.
// Arguments: the folder that prepare_scenes.py has filled (without it only scenes made here run), then Google Benchmark's.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "blem_sim/geometry/input_error.h"
#include "growing_scenes.h"
#include "sim/simulation_scene.h"
#include "soak/figures.h"
#include "soak/heap.h"
#include "support/shared_packages.h"
#include "support/surveyed_scan.h"

namespace blem_sim {
namespace {

constexpr double LONGEST = 60;  // [s] of processor time that the timed steps of a scene may take together

/** A scene and the number of its timed steps. */
struct Scene {
  std::string name;
  std::function<sim::SimulationConfig()> config;
  int warm_up, timed;      // [steps]
  std::string trajectory;  // file for the first robot, or none
};

sim::SimulationConfig stackOfCubes(int cubes) {
  sim::SimulationConfig config;
  config.environments = {sim::ground()};
  const double layers = 0.0025 + 0.0025;
  for (int i = 0; i < cubes; ++i)
    config.objects.push_back(
        sim::box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, Vector3(0, 0, 0.05 + (i + 1) * layers + i * 0.1 + 0.01 * (i + 1))));
  return config;
}

/** Sums over the timed steps. */
struct Totals {
  sim::StepProfile profile;
  double raw = 0, reduced = 0, pairs = 0, substeps = 0, redone = 0, iterations = 0, unreliable = 0;
  void add(const sim::StepReport& report) {
    for (std::size_t s = 0; s < profile.seconds.size(); ++s) profile.seconds[s] += report.profile.seconds[s];
    raw += report.raw_contacts;
    reduced += report.reduced_contacts;
    pairs += report.searched_pairs;
    substeps += report.substeps;
    redone += report.redone_solves;
    iterations += report.solver_iterations;
    unreliable += report.status & sim::CONTACT_UNRELIABLE ? 1 : 0;
  }
};

void count(const StepTimes& times, const Totals& totals, int steps, double seconds, double dt, benchmark::State* state) {
  auto& counters = state->counters;
  counters["real_time_factor"] = steps * dt / seconds;
  counters["steps"] = steps;
  counters["mean_us"] = 1e6 * seconds / steps;
  counters["p99_us"] = times.quantile(0.99);
  counters["max_us"] = times.worst();
  for (std::size_t s = 0; s < sim::STAGE_NAMES.size(); ++s)
    counters[std::string(sim::STAGE_NAMES[s]) + "_us"] = 1e6 * totals.profile.seconds[s] / steps;
  counters["raw_contacts"] = totals.raw / steps;
  counters["reduced_contacts"] = totals.reduced / steps;
  counters["pairs"] = totals.pairs / steps;
  counters["substeps"] = totals.substeps / steps;
  counters["redone_solves"] = totals.redone / steps;
  counters["iterations"] = totals.iterations / steps;
  counters["unreliable_steps"] = totals.unreliable;
}

void run(const Scene& scene, benchmark::State& state) {
  sim::Simulator simulator(scene.config(), model::UriResolver(sharedPackages()));
  std::vector<std::string> ignored;
  if (!scene.trajectory.empty())
    simulator.commandTrajectory(0, sim::loadTrajectoryCsv(scene.trajectory, simulator.robots()[0].joint_names, &ignored));
  for (int i = 0; i < scene.warm_up; ++i) simulator.step();
  StepTimes times;
  Totals totals;
  int steps = 0;
  const double start = threadSeconds();
  for (auto _ : state) {
    for (; steps < scene.timed && threadSeconds() - start < LONGEST; ++steps) {
      times.start();
      const sim::StepReport& report = simulator.step();
      times.stop();
      totals.add(report);
    }
    state.SetIterationTime(1e-6 * times.median());
  }
  char hash[17];
  std::snprintf(hash, sizeof(hash), "%016llx", static_cast<unsigned long long>(simulator.stateHash()));
  state.SetLabel(hash);  // of the last state
  count(times, totals, steps, threadSeconds() - start, simulator.config().time_step, &state);
}

void add(const Scene& scene) {
  benchmark::RegisterBenchmark(("scenes/" + scene.name).c_str(),
                               [scene](benchmark::State& state) {
                                 try {
                                   run(scene, state);
                                 } catch (const InputError& error) {
                                   state.SkipWithError(error.what());
                                 }
                               })
      ->Iterations(1)
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

void addPrepared(const std::filesystem::path& folder, const std::string& name, int warm_up, int timed) {
  const std::string config = (folder / (name + ".yaml")).string(), trajectory = (folder / (name + ".csv")).string();
  if (!std::filesystem::exists(config)) return;
  add({name, [config] { return sim::loadConfigFile(config); }, warm_up, timed, std::filesystem::exists(trajectory) ? trajectory : ""});
}

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  using namespace blem_sim;
  benchmark::Initialize(&argc, argv);
  if (argc > 2) return benchmark::ReportUnrecognizedArguments(argc - 1, argv + 1) ? 2 : 0;
  add({"ten_cubes", [] { return stackOfCubes(10); }, 500, 2000, ""});
  add({"heap_of_30", [] { return heapOfCubes(1, {}); }, 0, 3000, ""});
  for (const int threads : {1, 2})
    add({"40_stacks/threads:" + std::to_string(threads), [threads] { return stacksOfThree(40, threads); }, 500, 500, ""});
  const auto cubes_on_scan = [](const Vector3& offset) { return cubesOnSurveyedScan("benchmark", offset, 100, 9); };
  add({"scan/at_the_origin", [&] { return cubes_on_scan(Vector3::Zero()); }, 100, 3000, ""});
  add({"scan/surveyed", [&] { return cubes_on_scan(EASTING_NORTHING); }, 100, 3000, ""});
  add({"scan/surveyed_world", [&] { return movedTo(EASTING_NORTHING, cubes_on_scan(EASTING_NORTHING)); }, 100, 3000, ""});
  if (argc == 2) {
    addPrepared(argv[1], "hubo_plane", 500, 2000);
    addPrepared(argv[1], "hubo_plane_sway", 500, 2000);
    addPrepared(argv[1], "stepladder_150k", 500, 1000);
    addPrepared(argv[1], "stepladder_1m", 500, 1000);
    addPrepared(argv[1], "tray18", 1000, 1000);
  } else {
    std::printf("scenes of the shared data are left out: no folder of prepare_scenes.py is given\n");
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
