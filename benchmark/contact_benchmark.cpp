// Contact generation on given motions, with and without a memory of the step before, against a plain tree that lists the pairs of triangles
// within reach, and against the kernels alone on the pairs of features that have a contact. Processor time per step, median of the steps;
// mean, p99, contacts, pairs and ratios as counters. Arguments: Google Benchmark's.
#include <benchmark/benchmark.h>

#include "contact_generation.h"
#include "known_pairs.h"

namespace blem_sim {
namespace {

constexpr int STEPS = 1000;

void run(benchmark::State& state, std::unique_ptr<ContactScene> (*make)()) {
  const std::unique_ptr<ContactScene> scene = make();
  if (!scene) {
    state.SkipWithError("the shared data are not here (set BLEM_SIM_SHARED_DATA to their folder)");
    return;
  }
  for (auto _ : state) {
    const PairSearch plain = searchPlainly(*scene), limit = runKernelsOnKnownPairs(*scene);
    const Generation fresh = generate(*scene, false, STEPS), coherent = generate(*scene, true, STEPS);
    state.SetIterationTime(1e-6 * coherent.times.median());
    state.counters["mean_us"] = coherent.times.mean();
    state.counters["p99_us"] = coherent.times.quantile(0.99);
    state.counters["max_us"] = coherent.times.worst();
    state.counters["fresh_us"] = fresh.times.mean();
    state.counters["plain_us"] = plain.microseconds;
    state.counters["plain_over_mean"] = plain.microseconds / coherent.times.mean();
    state.counters["plain_over_fresh"] = plain.microseconds / fresh.times.mean();
    state.counters["p99_over_fresh"] = coherent.times.quantile(0.99) / fresh.times.mean();
    state.counters["contacts"] = coherent.contacts;
    state.counters["pairs"] = plain.pairs;
    state.counters["kernel_us"] = limit.microseconds;
    state.counters["known_pairs"] = limit.pairs;
    state.counters["mean_over_kernel"] = coherent.times.mean() / limit.microseconds;
    state.counters["fresh_over_kernel"] = fresh.times.mean() / limit.microseconds;
  }
}

void add(const char* name, std::unique_ptr<ContactScene> (*make)()) {
  benchmark::RegisterBenchmark(name, [make](benchmark::State& state) { run(state, make); })
      ->Unit(benchmark::kMicrosecond)
      ->UseManualTime()
      ->Iterations(1);
}

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  using namespace blem_sim;
  add("contacts/hubo_on_100k", [] { return huboOnTerrain(100000); });
  add("contacts/hubo_on_1M", [] { return huboOnTerrain(1000000); });
  add("contacts/hubo_on_1M_points", [] { return huboOnTerrain(2000000, true); });
  add("contacts/cube_on_1M", [] { return cubeOnTerrain(1000000); });
  add("contacts/mug_on_fractal_500k", [] { return mugOnFractalTerrain(500000); });
  add("contacts/mug_beside_mug", [] { return mugBesideMug(); });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
