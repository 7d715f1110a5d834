// Contact generation on given motions, against a plain tree that lists the pairs of triangles within reach. Processor time per step,
// median of the steps; p99, contacts, pairs and the ratio as counters. Arguments: Google Benchmark's.
#include <benchmark/benchmark.h>

#include "blem_sim/contact/narrow_phase.h"
#include "blem_sim/contact/reduction.h"
#include "contact_scenes.h"
#include "plain_tree.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

constexpr int STEPS = 200, PLAIN_STEPS = 10;  // the plain tree hardly varies

/** [us] per step, mean; the number of pairs found. */
std::pair<double, double> plainTime(const ContactScene& scene) {
  const PlainTree standing(scene.standing.geometry->mesh());
  std::vector<std::unique_ptr<PlainTree>> moving;
  for (const Collider& collider : scene.moving) moving.push_back(std::make_unique<PlainTree>(collider.geometry->mesh()));
  std::vector<std::pair<int, int>> pairs;
  std::size_t found = 0;
  const double start = threadSeconds();
  for (int step = 0; step < PLAIN_STEPS; ++step) {
    for (std::size_t i = 0; i < moving.size(); ++i) {
      const int collider = static_cast<int>(i);
      const double range = scene.moving[i].radius + scene.standing.radius;
      PlainTree::trianglePairs(*moving[i], standing, scene.pose(collider, step * STEPS / PLAIN_STEPS), range, &pairs);
      found += pairs.size();
    }
  }
  return {1e6 * (threadSeconds() - start) / PLAIN_STEPS, static_cast<double>(found) / PLAIN_STEPS};
}

/** One step: contacts of every moving collider, reduced to 50. */
std::size_t step(const ContactScene& scene, int step, ContactManifold* manifold) {
  std::size_t contacts = 0;
  for (std::size_t i = 0; i < scene.moving.size(); ++i) {
    const Pose X = scene.pose(static_cast<int>(i), step);
    narrowPhase(scene.moving[i], X, scene.standing, Pose::Identity(), 0, manifold);
    contacts += manifold->contacts.size();
  }
  return contacts;
}

void run(benchmark::State& state, std::unique_ptr<ContactScene> (*make)()) {
  const std::unique_ptr<ContactScene> scene = make();
  if (!scene) {
    state.SkipWithError("the shared data are not here (set BLEM_SIM_SHARED_DATA to their folder)");
    return;
  }
  const auto [plain, pairs] = plainTime(*scene);
  ContactManifold manifold;
  StepTimes times;
  double contacts = 0, total = 0;
  for (auto _ : state) {
    for (int k = 0; k < STEPS; ++k) {
      const double start = threadSeconds();
      times.start();
      contacts += static_cast<double>(step(*scene, k, &manifold));
      times.stop();
      total += threadSeconds() - start;
    }
    state.SetIterationTime(1e-6 * times.median());
  }
  const double mean = 1e6 * total / (STEPS * static_cast<double>(state.iterations()));
  state.counters["p99_us"] = times.quantile(0.99);
  state.counters["contacts"] = contacts / (STEPS * static_cast<double>(state.iterations()));
  state.counters["pairs"] = pairs;
  state.counters["plain_us"] = plain;
  state.counters["plain_over_mean"] = plain / mean;
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
  add("contacts/hubo_on_10k", [] { return huboOnTerrain(10000); });
  add("contacts/hubo_on_100k", [] { return huboOnTerrain(100000); });
  add("contacts/hubo_on_1M", [] { return huboOnTerrain(1000000); });
  add("contacts/cube_on_1M", [] { return cubeOnTerrain(1000000); });
  add("contacts/mug_on_fractal_500k", [] { return mugOnFractalTerrain(500000); });
  add("contacts/mug_beside_mug", [] { return mugBesideMug(); });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
