// Growth of times: with the triangles of an environment under a fixed footprint, with contacts, bodies, threads. Every curve is one run in
// which its points take turns, so that ratios mean more than times. Arguments: Google Benchmark's.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "blem_sim/reduction/reduction.h"
#include "blem_sim/sim/simulator.h"
#include "contact/contact_shapes.h"
#include "contact_generation.h"
#include "growing_scenes.h"
#include "support/shared_packages.h"

namespace blem_sim {
namespace {

constexpr int ROUNDS = 7, STEPS = 200;  // one oscillation of the contact scenes
constexpr int MANY = 1000;              // bodies

/** Mean times over a round [us]; NaN: not part of it. */
struct Sample {
  double mean = NAN;      ///< of the time that the curve shows
  double fresh = NAN;     ///< without a memory of the step before
  double contacts = NAN;  ///< raw
  double narrow_phase = NAN, reduction = NAN, solve = NAN;
};

struct Point {
  std::string name;
  double size;
  std::function<std::function<Sample()>()> prepare;  ///< returns a function that measures a round
};

struct Curve {
  std::vector<Point> points;
  bool same_contacts = false;               ///< every point must have as many contacts as the first
  std::vector<std::vector<Sample>> rounds;  ///< by point; empty until measured
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double medianOf(const std::vector<Sample>& rounds, double Sample::*member) {
  std::vector<double> values;
  for (const Sample& sample : rounds) values.push_back(sample.*member);
  return median(values);
}

/** Median of the rounds' ratios. */
double ratio(const std::vector<Sample>& rounds, const std::vector<Sample>& first, double Sample::*member) {
  std::vector<double> values;
  for (std::size_t i = 0; i < rounds.size(); ++i) values.push_back(rounds[i].*member / first[i].*member);
  return median(values);
}

void measure(Curve* curve) {
  std::vector<std::function<Sample()>> points;
  for (const Point& point : curve->points) points.push_back(point.prepare());
  curve->rounds.resize(points.size());
  for (int round = 0; round < ROUNDS; ++round)
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i]) curve->rounds[i].push_back(points[i]());
}

void report(Curve* curve, std::size_t i, benchmark::State* state) {
  if (curve->rounds.empty()) measure(curve);
  const std::vector<Sample>& rounds = curve->rounds[i];
  if (rounds.empty()) {
    state->SkipWithError("the shared data are not here (set BLEM_SIM_SHARED_DATA to their folder)");
    return;
  }
  if (curve->same_contacts && rounds[0].contacts != curve->rounds[0][0].contacts) {
    state->SkipWithError("the footprint is not the first one's: other contacts");
    return;
  }
  for (auto _ : *state) state->SetIterationTime(1e-6 * medianOf(rounds, &Sample::mean));
  auto& counters = state->counters;
  counters["size"] = curve->points[i].size;
  counters["over_first"] = ratio(rounds, curve->rounds[0], &Sample::mean);
  counters["fresh_us"] = medianOf(rounds, &Sample::fresh);
  counters["fresh_over_first"] = ratio(rounds, curve->rounds[0], &Sample::fresh);
  counters["contacts"] = medianOf(rounds, &Sample::contacts);
  counters["narrow_phase_us"] = medianOf(rounds, &Sample::narrow_phase);
  counters["reduction_us"] = medianOf(rounds, &Sample::reduction);
  counters["solve_us"] = medianOf(rounds, &Sample::solve);
}

// ---- contact generation

using MakeScene = std::unique_ptr<ContactScene> (*)(int size);

/** [us] per call: the contacts of one pair to k, step after step. */
double reductionTime(const ContactScene& scene, int k) {
  std::vector<contact::Contact> reduced;
  std::vector<std::uint64_t> before;
  reduction::ReductionWorkspace workspace;
  double total = 0;
  for (int step = -1; step < STEPS; ++step) {
    const contact::ContactManifold manifold =
        contact::contactsOf(scene.moving[0], scene.pose(0, step), scene.standing, Pose::Identity(), 0);
    const double start = threadSeconds();
    reduction::reduceHull(manifold.contacts, k, before, &workspace, &reduced);
    if (step >= 0) total += threadSeconds() - start;
    before.clear();
    for (const contact::Contact& contact : reduced) before.push_back(contact.id);
    std::sort(before.begin(), before.end());
  }
  return 1e6 * total / STEPS;
}

Sample generated(const ContactScene& scene, bool reduces) {
  const Generation fresh = generate(scene, false, STEPS), coherent = generate(scene, true, STEPS);
  Sample sample;
  sample.mean = sample.narrow_phase = coherent.times.mean();
  sample.fresh = fresh.times.mean();
  sample.contacts = coherent.contacts;
  if (reduces) sample.reduction = reductionTime(scene, 20);
  return sample;
}

Point generation(const std::string& name, int size, MakeScene make, bool reduces) {
  return {name + std::to_string(size), static_cast<double>(size), [=]() -> std::function<Sample()> {
            const std::shared_ptr<const ContactScene> scene = make(size);
            if (!scene) return nullptr;
            return [scene, reduces] { return generated(*scene, reduces); };
          }};
}

Curve triangles(const std::string& name, MakeScene make, int from) {
  Curve curve;
  curve.same_contacts = true;
  for (const int size : {1000, 10000, 100000, 1000000, 4000000})
    if (size >= from) curve.points.push_back(generation("triangles/" + name + "/", size, make, false));
  return curve;
}

Curve contacts() {
  Curve curve;
  for (const int size : {10, 30, 100, 300, 1000, 3000, 10000})
    curve.points.push_back(generation("contacts/slab/", size, slabOnTerrain, true));
  return curve;
}

// ---- whole steps

/** @param clock [s] that the step is timed by; its stages are wall time */
Point wholeStep(const std::string& name, int size, const sim::SimulationConfig& config, double (*clock)()) {
  return {name + std::to_string(size), static_cast<double>(size), [=]() -> std::function<Sample()> {
            // Fewer steps of a large scene say as much.
            const int warm_up = size < MANY ? 400 : 150, steps = size < MANY ? STEPS : 20;
            const auto simulator = std::make_shared<sim::Simulator>(config, model::UriResolver(sharedPackages()));
            for (int i = 0; i < warm_up; ++i) simulator->step();
            return [simulator, clock, steps] {
              sim::StepProfile profile;
              double contacts = 0;
              const double start = clock();
              for (int i = 0; i < steps; ++i) {
                const sim::StepReport& report = simulator->step();
                for (std::size_t s = 0; s < profile.seconds.size(); ++s) profile.seconds[s] += report.profile.seconds[s];
                contacts += report.raw_contacts;
              }
              const auto mean = [&](sim::Stage stage) { return 1e6 * profile.seconds[static_cast<int>(stage)] / steps; };
              Sample sample;
              sample.mean = 1e6 * (clock() - start) / steps;
              sample.contacts = contacts / steps;
              sample.narrow_phase = mean(sim::Stage::NARROW_PHASE);
              sample.reduction = mean(sim::Stage::REDUCTION);
              sample.solve = mean(sim::Stage::SOLVE);
              return sample;
            };
          }};
}

Curve bodies() {
  Curve curve;
  for (const int size : {1, 2, 5, 10, 20, 50, 100, 1000, 3000, 10000})
    curve.points.push_back(wholeStep("bodies/cubes/", size, cubesOnGround(size), threadSeconds));
  return curve;
}

Curve threads() {
  Curve curve;
  for (const int size : {1, 2}) curve.points.push_back(wholeStep("threads/40_stacks/", size, stacksOfThree(40, size), wallSeconds));
  return curve;
}

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  using namespace blem_sim;
  std::vector<Curve> curves = {triangles("hubo", huboOnGrowingTerrain, 10000), triangles("cube", cubeOnGrowingTerrain, 1000), contacts(),
                               bodies(), threads()};
  for (Curve& curve : curves) {
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      benchmark::RegisterBenchmark(("scaling/" + curve.points[i].name).c_str(),
                                   [&curve, i](benchmark::State& state) { report(&curve, i, &state); })
          ->Iterations(1)
          ->UseManualTime()
          ->Unit(benchmark::kMicrosecond);
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
