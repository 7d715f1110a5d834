// Contact generation on given motions, with and without a memory of the step before, against a plain tree that lists the pairs of triangles
// within reach. Processor time per step, median of the steps; mean, p99, contacts, pairs and the ratio as counters. Arguments: Google
// Benchmark's.
#include <benchmark/benchmark.h>

#include "blem_sim/contact/narrow_phase.h"
#include "blem_sim/contact/reduction.h"
#include "contact_scenes.h"
#include "plain_tree.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

constexpr int STEPS = 1000, PLAIN_STEPS = 10;  // the plain tree hardly varies

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
      PlainTree::trianglePairs(*moving[i], standing, scene.pose(collider, step * 200 / PLAIN_STEPS), range, &pairs);
      found += pairs.size();
    }
  }
  return {1e6 * (threadSeconds() - start) / PLAIN_STEPS, static_cast<double>(found) / PLAIN_STEPS};
}

/** Contacts of every moving collider in every step. */
struct Generation {
  StepTimes times;
  double mean = 0;      ///< [us]
  double contacts = 0;  ///< per step, mean
};

Generation generate(const ContactScene& scene, bool remembers) {
  std::vector<NarrowPhaseMemory> memories(scene.moving.size());
  ContactManifold manifold;
  Generation out;
  double total = 0;
  for (int step = -1; step < STEPS; ++step) {  // the first one fills the memory
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < scene.moving.size(); ++i) poses.push_back(scene.pose(static_cast<int>(i), step));
    std::size_t contacts = 0;
    const double start = threadSeconds();
    out.times.start();
    for (std::size_t i = 0; i < scene.moving.size(); ++i) {
      narrowPhase(scene.moving[i], poses[i], scene.standing, Pose::Identity(), 0, &manifold, nullptr, remembers ? &memories[i] : nullptr);
      contacts += manifold.contacts.size();
    }
    out.times.stop();
    if (step < 0) {
      out.times = StepTimes();
      continue;
    }
    total += threadSeconds() - start;
    out.contacts += static_cast<double>(contacts) / STEPS;
  }
  out.mean = 1e6 * total / STEPS;
  return out;
}

void run(benchmark::State& state, std::unique_ptr<ContactScene> (*make)()) {
  const std::unique_ptr<ContactScene> scene = make();
  if (!scene) {
    state.SkipWithError("the shared data are not here (set BLEM_SIM_SHARED_DATA to their folder)");
    return;
  }
  const auto [plain, pairs] = plainTime(*scene);
  for (auto _ : state) {
    const Generation fresh = generate(*scene, false), coherent = generate(*scene, true);
    state.SetIterationTime(1e-6 * coherent.times.median());
    state.counters["mean_us"] = coherent.mean;
    state.counters["p99_us"] = coherent.times.quantile(0.99);
    state.counters["max_us"] = coherent.times.worst();
    state.counters["fresh_us"] = fresh.mean;
    state.counters["plain_us"] = plain;
    state.counters["plain_over_mean"] = plain / coherent.mean;
    state.counters["plain_over_fresh"] = plain / fresh.mean;
    state.counters["p99_over_fresh"] = coherent.times.quantile(0.99) / fresh.mean;
    state.counters["contacts"] = coherent.contacts;
    state.counters["pairs"] = pairs;
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
  add("contacts/hubo_on_10k", [] { return huboOnTerrain(10000); });
  add("contacts/hubo_on_100k", [] { return huboOnTerrain(100000); });
  add("contacts/hubo_on_1M", [] { return huboOnTerrain(1000000); });
  add("contacts/hubo_on_4M", [] { return huboOnTerrain(4000000); });
  add("contacts/hubo_on_1M_points", [] { return huboOnTerrain(2000000, true); });
  add("contacts/cube_on_1M", [] { return cubeOnTerrain(1000000); });
  add("contacts/mug_on_fractal_500k", [] { return mugOnFractalTerrain(500000); });
  add("contacts/mug_beside_mug", [] { return mugBesideMug(); });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
