// Processor time of single steps: the Hubo of the shared data standing and swaying, a stack, a heap; steppers side by side in one run.
// Every row is one run of many steps; its time is the median step. Arguments: Google Benchmark's.
#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <memory>

#include "soak/figures.h"
#include "soak/heap.h"
#include "soak/hubo_stand.h"

namespace blem_sim {
namespace {

constexpr int SETTLE_STEPS = 1500, WARM_UP_STEPS = 20;
constexpr int STEPS = 10000, SLOW_STEPS = 200;  // timed; the second for world_step

dynamics::SolverSettings stepper(const std::string& name) {
  dynamics::SolverSettings settings;
  settings.stepper = name;
  return settings;
}

int stepsFor(const std::string& name) { return name == "world_step" ? SLOW_STEPS : STEPS; }

HuboOptions standOptions(const std::string& name, int contacts) {
  HuboOptions options;
  options.settings = stepper(name);
  options.sole_contacts = contacts;
  return options;
}

/** Times of `steps` steps, without their preparation. */
StepTimes timed(int steps, const std::function<void()>& prepare, const std::function<bool()>& step) {
  StepTimes times;
  for (int i = 0; i < steps; ++i) {
    prepare();
    times.start();
    const bool finite = step();
    times.stop();
    if (!finite) break;
  }
  return times;
}

StepTimes timedStand(HuboStand* hubo, int steps) {
  return timed(
      steps, [&] { hubo->prepare(); }, [&] { return hubo->solve().finite; });
}

/** A stand that came to rest under `articulated`: where every stepper starts, so that none is measured while it falls. */
const HuboStand& settled(int contacts) {
  static std::map<int, std::unique_ptr<HuboStand>> stands;
  std::unique_ptr<HuboStand>& stand = stands[contacts];
  if (!stand) {
    stand = std::make_unique<HuboStand>(standOptions("articulated", contacts));
    for (int i = 0; i < SETTLE_STEPS; ++i) stand->step();
  }
  return *stand;
}

StepTimes stand(const std::string& name, int contacts) {
  HuboStand hubo(standOptions(name, contacts));
  hubo.copyState(settled(contacts));
  for (int i = 0; i < WARM_UP_STEPS; ++i) hubo.step();
  return timedStand(&hubo, stepsFor(name));
}

StepTimes landing(int contacts) {
  HuboStand hubo(standOptions("articulated", contacts));
  return timedStand(&hubo, SETTLE_STEPS);
}

StepTimes sway(const std::string& name) {
  HuboOptions options = standOptions(name, 50);
  options.start_at = HUBO_SWAY;
  HuboStand hubo(options);
  for (int i = 0; i < 1000; ++i) hubo.step();
  const double length = hubo.follow(HUBO_SWAY);
  return timedStand(&hubo, static_cast<int>(1000 * (length + 1.5)));
}

StepTimes stack(const std::string& name) {
  const Vector3 cube(0.1, 0.1, 0.1);
  dynamics::World world(Vector3(0, 0, -9.81), stepper(name));
  for (int i = 0; i < 10; ++i) world.addBody(dynamics::boxBody("cube", 1, cube, {0, 0, 0.05 + 0.1 * i}));
  std::vector<dynamics::ContactConstraint> contacts;
  const auto prepare = [&] {
    contacts.clear();
    dynamics::boxOnPlane(world, 0, cube, Vector3::UnitZ(), 0, {}, &contacts);
    for (int i = 1; i < 10; ++i) dynamics::boxOnBox(world, i, cube, i - 1, cube, {}, &contacts);
  };
  return timed(stepsFor(name), prepare, [&] { return world.step(1e-3, contacts, {}).finite; });
}

/** Contacts of meshes included. */
StepTimes heap(const std::string& name) {
  sim::Simulator simulator(heapOfCubes(1, stepper(name)), model::UriResolver());
  const int steps = name == "world_step" ? 1000 : 3000;
  return timed(
      steps, [] {}, [&] { return !(simulator.step().status & sim::STATE_NOT_FINITE); });
}

std::map<std::string, StepTimes>& results() {
  static std::map<std::string, StepTimes> times;
  return times;
}

void add(const std::string& name, const std::function<StepTimes()>& run) {
  const auto body = [name, run](benchmark::State& state) {
    for (auto _ : state) {
      const StepTimes times = run();
      state.SetIterationTime(1e-6 * times.median());
      state.counters["median_us"] = times.median();
      state.counters["p99_us"] = times.quantile(0.99);
      state.counters["max_us"] = times.worst();
      state.counters["p99_over_median"] = times.quantile(0.99) / times.median();
      results()[name] = times;
    }
  };
  benchmark::RegisterBenchmark(name.c_str(), body)->Iterations(1)->UseManualTime()->Unit(benchmark::kMicrosecond);
}

void addHubo() {
  for (const int contacts : {4, 8, 20, 50, 100})
    add("stand/articulated/" + std::to_string(contacts), [contacts] { return stand("articulated", contacts); });
  for (const int contacts : {8, 20, 50})
    for (const std::string name : {"world_step", "quick_step"})
      add("stand/" + name + "/" + std::to_string(contacts), [name, contacts] { return stand(name, contacts); });
  add("landing/articulated/50", [] { return landing(50); });
  add("sway/articulated/50", [] { return sway("articulated"); });
}

void printRatio(const std::string& name, const std::string& tested, const std::string& reference) {
  const auto a = results().find(tested), b = results().find(reference);
  if (a == results().end() || b == results().end()) return;
  std::printf("ratio: %s: %.3g us / %.3g us = 1/%.0f\n", name.c_str(), a->second.median(), b->second.median(),
              b->second.median() / a->second.median());
}

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  using namespace blem_sim;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  if (sharedData(HUBO_FOLDER))
    addHubo();
  else
    std::printf("the Hubo is left out: shared data not found (set BLEM_SIM_SHARED_DATA to their folder)\n");
  for (const std::string name : {"articulated", "world_step", "quick_step"}) add("stack/" + name + "/10", [name] { return stack(name); });
  for (const std::string name : {"articulated", "quick_step"}) add("heap/" + name + "/30", [name] { return heap(name); });
  benchmark::RunSpecifiedBenchmarks();
  printRatio("Hubo standing on 50 contacts, articulated / world_step", "stand/articulated/50", "stand/world_step/50");
  printRatio("Hubo standing on 50 contacts, articulated / quick_step", "stand/articulated/50", "stand/quick_step/50");
  printRatio("stack of ten cubes, articulated / world_step", "stack/articulated/10", "stack/world_step/10");
  return 0;
}
