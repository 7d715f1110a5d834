// Times of other engines' mesh queries, beside contact generation in the same run. Processor time per step, mean over some poses; the label
// names the query's result. Arguments: Google Benchmark's.
#include <benchmark/benchmark.h>

#include <cstdio>

#include "contact_generation.h"
#include "peers/peer.h"

namespace blem_sim {
namespace {

using MakeScene = std::unique_ptr<ContactScene> (*)();

/** A scene and blem_sim's own times on it. */
struct Measured {
  MakeScene make = nullptr;
  std::unique_ptr<ContactScene> scene;
  Generation fresh, coherent;
};

/** The last scene asked for is kept: rows of one scene follow each other. */
const Measured& measured(MakeScene make) {
  constexpr int STEPS = 200;
  static Measured last;
  if (last.make == make) return last;
  last = Measured();
  last.make = make;
  last.scene = make();
  if (last.scene) {
    last.fresh = generate(*last.scene, false, STEPS);
    last.coherent = generate(*last.scene, true, STEPS);
  }
  return last;
}

/** Times of a peer, mean over sampled steps, each asked once before. */
PairSearch timed(const ContactScene& scene, const PeerRow& row) {
  const std::unique_ptr<Peer> peer = row.make(scene);
  const std::vector<int> steps = sampledSteps();
  PairSearch out;
  for (const int step : steps) {
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < scene.moving.size(); ++i) {
      poses.push_back(scene.pose(static_cast<int>(i), step));
      if (row.pushed_in) poses[i].pretranslate((scene.moving[i].radius + scene.standing.radius) * scene.approach);
    }
    for (const bool counts : {false, true}) {
      const double start = threadSeconds();
      std::size_t found = 0;
      for (std::size_t i = 0; i < poses.size(); ++i) found += peer->query(i, poses[i]);
      if (!counts) continue;
      out.microseconds += 1e6 * (threadSeconds() - start) / static_cast<double>(steps.size());
      out.pairs += static_cast<double>(found) / static_cast<double>(steps.size());
    }
  }
  return out;
}

void run(benchmark::State& state, MakeScene make, const PeerRow& row) {
  const Measured& ours = measured(make);
  if (!ours.scene) {
    state.SkipWithError("the shared data are not here (set BLEM_SIM_SHARED_DATA to their folder)");
    return;
  }
  for (auto _ : state) {
    const PairSearch peer = timed(*ours.scene, row);
    state.SetIterationTime(1e-6 * peer.microseconds);
    state.counters["found"] = peer.pairs;
    state.counters["mean_us"] = ours.coherent.times.mean();
    state.counters["fresh_us"] = ours.fresh.times.mean();
    state.counters["contacts"] = ours.coherent.contacts;
    state.counters["peer_over_mean"] = peer.microseconds / ours.coherent.times.mean();
    state.counters["peer_over_fresh"] = peer.microseconds / ours.fresh.times.mean();
  }
  state.SetLabel(row.computes);
}

struct Scene {
  const char* name;
  MakeScene make;
};

const Scene SCENES[] = {{"hubo_on_1M", [] { return huboOnTerrain(1000000); }},
                        {"cube_on_1M", [] { return cubeOnTerrain(1000000); }},
                        {"mug_on_fractal_500k", [] { return mugOnFractalTerrain(500000); }},
                        {"mug_beside_mug", [] { return mugBesideMug(); }}};

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  using namespace blem_sim;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  for (const std::string& missing : missingPeers()) std::printf("left out, not installed: %s\n", missing.c_str());
  for (const Scene& scene : SCENES) {
    for (const PeerRow& row : peers()) {
      const std::string name = std::string("peers/") + scene.name + "/" + row.name;
      benchmark::RegisterBenchmark(name.c_str(), [&scene, row](benchmark::State& state) { run(state, scene.make, row); })
          ->Unit(benchmark::kMicrosecond)
          ->UseManualTime()
          ->Iterations(1);
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
