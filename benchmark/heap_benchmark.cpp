// Heaps in a bin beside Bullet: cubes of twelve triangles (there boxes), exact spheres. Both take turns in one run, so that ratios mean
// more than times. Processor time of one thread, of stages too. One island on one thread, on two and on as many as the simulator chooses,
// in turns, by the wall's clock (stages: processor time of the stepping thread). Arguments: --seconds=S simulated (4 if not given),
// --seed=N of the heap (1; heaps are chaotic, so that seeds tell more than a repetition), then Google Benchmark's:
// --benchmark_filter='cubes/(30|100)/' chooses sizes.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "bullet_heap.h"
#include "soak/figures.h"
#include "soak/heap.h"
#include "support/shared_packages.h"

namespace blem_sim {
namespace {

constexpr int TURN = 50;  // [steps] of one engine before it is the other's turn
constexpr std::size_t STAGES = static_cast<std::size_t>(sim::Stage::COUNT), SOLVE = static_cast<std::size_t>(sim::Stage::SOLVE);
double seconds_simulated = 4;
int heap_seed = 1;

/** A heap that both engines run. */
struct Heap {
  std::string name;
  int count;
  sim::SimulationConfig (*config)(int count, int seed, const dynamics::SolverSettings& solver);
  HeapScene (*scene)(int count);
};

HeapScene cubes(int count) {
  HeapScene scene;
  scene.size = 0.1;
  scene.mass = 1;
  scene.friction = 0.5;
  scene.bin_width = heapBinWidth(count);
  scene.bin_height = heapBinHeight(count);
  scene.poses = heapPoses(count, heap_seed);
  return scene;
}

HeapScene spheres(int count) {
  HeapScene scene;
  scene.spheres = true;
  scene.size = 2 * POURED_RADIUS;
  scene.mass = POURED_MASS;
  scene.friction = 0.5;
  scene.bin_width = pouredBinWidth(count);
  scene.bin_height = pouredBinHeight(count);
  scene.poses = pouredPoses(count, heap_seed);
  return scene;
}

/** Times [us] of each step of one thing. */
class Times {
 public:
  void add(double seconds) { all_.push_back(1e6 * seconds); }
  double mean(double from = 0, double to = 1) const {
    const auto begin = static_cast<std::size_t>(from * all_.size()), end = static_cast<std::size_t>(to * all_.size());
    double total = 0;
    for (std::size_t i = begin; i < end; ++i) total += all_[i];
    return total / static_cast<double>(end - begin);
  }
  double quantile(double fraction) const {
    std::vector<double> sorted = all_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(fraction * static_cast<double>(sorted.size() - 1))];
  }

 private:
  std::vector<double> all_;
};

dynamics::SolverSettings onThreads(int count) {
  dynamics::SolverSettings solver;
  solver.threads = count;
  return solver;
}

double fastest(const sim::StepReport& report) {
  double fastest = 0;
  for (const dynamics::BodyState& body : report.bodies) fastest = std::max(fastest, body.v_WCom.norm());
  return fastest;
}

/** A heap tumbles while it has a contact per body and something in it is this fast; it rests below the other speed. [m/s] */
constexpr double TUMBLES = 0.1, RESTS = 1e-6;

/** Results of a run. */
struct Figures {
  Times step, bullet;
  Times solve_tumbling, solve_resting;
  std::array<Times, STAGES> stages;
  Times residual_of_force;  // in millionths
  double trouble = 0, crossing = 0, shortened = 0, deepest = 0, gained = 0, bullet_deepest = 0;
  void add(const sim::StepReport& report) {
    for (std::size_t s = 0; s < STAGES; ++s) stages[s].add(report.profile.seconds[s]);
    const double solve = report.profile.seconds[SOLVE], speed = fastest(report);
    if (speed > TUMBLES && report.contacts.size() >= report.bodies.size()) solve_tumbling.add(solve);
    if (speed < RESTS) solve_resting.add(solve);
    trouble += report.status & sim::SOLVER_TROUBLE ? 1 : 0;
    crossing += report.status & sim::CONTACT_UNRELIABLE ? 1 : 0;
    shortened += report.substeps > 1 ? 1 : 0;
    deepest = std::max(deepest, report.max_of_layer);
    gained = std::max(gained, report.energy_gained);
    double largest = 0;
    for (const sim::ContactReport& contact : report.contacts) largest = std::max(largest, contact.force.norm());
    if (largest > 0) residual_of_force.add(report.solver_residual / largest);
  }
};

Figures run(sim::Simulator* simulator, BulletHeap* bullet) {
  Figures figures;
  const int steps = static_cast<int>(std::lround(seconds_simulated / simulator->config().time_step));
  for (int done = 0; done < steps; done += TURN) {
    const int turn = std::min(TURN, steps - done);
    for (int i = 0; i < turn; ++i) {
      const double start = threadSeconds();
      const sim::StepReport& report = simulator->step();
      figures.step.add(threadSeconds() - start);
      figures.add(report);
    }
    for (int i = 0; bullet && i < turn; ++i) {
      const double start = threadSeconds();
      bullet->step();
      figures.bullet.add(threadSeconds() - start);
      figures.bullet_deepest = std::max(figures.bullet_deepest, bullet->deepest());
    }
  }
  return figures;
}

/** Bodies that are not in the bin any more. */
int lost(const sim::Simulator& simulator, double width) {
  int lost = 0;
  for (const dynamics::BodyState& body : simulator.report().bodies) {
    const Vector3& p = body.X_WB.translation();
    lost += p.z() < 0 || std::max(std::abs(p.x()), std::abs(p.y())) > 0.5 * width ? 1 : 0;
  }
  return lost;
}

void count(const Heap& heap, const Figures& figures, const sim::Simulator& simulator, const BulletHeap* bullet, benchmark::State* state) {
  auto& counters = state->counters;
  const double steps = seconds_simulated / simulator.config().time_step;
  const auto add = [&](const std::string& name, const Times& times) {
    counters[name + "_mean_us"] = times.mean();
    counters[name + "_p99_us"] = times.quantile(0.99);
    counters[name + "_max_us"] = times.quantile(1);
  };
  add("step", figures.step);
  for (std::size_t s = 0; s < STAGES; ++s) add(sim::STAGE_NAMES[s], figures.stages[s]);
  const Times& solve = figures.stages[SOLVE];
  counters["last_quarter_over_first"] = figures.step.mean(0.75, 1) / figures.step.mean(0, 0.25);
  counters["solve_last_quarter_over_first"] = solve.mean(0.75, 1) / solve.mean(0, 0.25);
  counters["trouble_share"] = figures.trouble / steps;
  counters["crossing_steps"] = figures.crossing;
  counters["shortened_steps"] = figures.shortened;
  counters["residual_of_force_p999"] = 1e-6 * figures.residual_of_force.quantile(0.999);
  counters["residual_of_force_worst"] = 1e-6 * figures.residual_of_force.quantile(1);
  counters["deepest_of_layer"] = figures.deepest;
  counters["energy_gained_J"] = figures.gained;
  counters["speed_at_end"] = fastest(simulator.report());
  counters["lost"] = lost(simulator, heap.scene(heap.count).bin_width);
  counters["bullet_mean_us"] = bullet ? figures.bullet.mean() : NAN;
  counters["bullet_p99_us"] = bullet ? figures.bullet.quantile(0.99) : NAN;
  counters["bullet_deepest_mm"] = 1e3 * figures.bullet_deepest;
  counters["bullet_speed_at_end"] = bullet ? bullet->fastest() : NAN;
  counters["solve_over_bullet"] = bullet ? solve.mean() / figures.bullet.mean() : NAN;
  counters["step_over_bullet"] = bullet ? figures.step.mean() / figures.bullet.mean() : NAN;
  // Growth against the heap of 100 of this run.
  static double solve_of_100 = NAN, step_of_100 = NAN, tumbling_of_100 = NAN;
  if (heap.name == "cubes" && heap.count == 100) {
    solve_of_100 = solve.mean();
    step_of_100 = figures.step.mean();
    tumbling_of_100 = figures.solve_tumbling.mean();
  }
  counters["solve_over_100"] = solve.mean() / solve_of_100;
  counters["step_over_100"] = figures.step.mean() / step_of_100;
  counters["solve_tumbling_mean_us"] = figures.solve_tumbling.mean();
  counters["solve_tumbling_over_100"] = figures.solve_tumbling.mean() / tumbling_of_100;
  counters["solve_resting_over_tumbling"] = figures.solve_resting.mean() / figures.solve_tumbling.mean();
}

void measure(const Heap& heap, benchmark::State& state) {
  sim::Simulator simulator(heap.config(heap.count, heap_seed, onThreads(1)), model::UriResolver(sharedPackages()));
  const std::unique_ptr<BulletHeap> bullet = makeBulletHeap(heap.scene(heap.count));
  Figures figures;
  for (auto _ : state) {
    figures = run(&simulator, bullet.get());
    state.SetIterationTime(1e-6 * figures.step.mean());
  }
  count(heap, figures, simulator, bullet.get(), &state);
}

/** A row that is run once. */
template <typename Run>
void add(const std::string& name, int count, const Run& run) {
  benchmark::RegisterBenchmark(("heaps/" + name + "/" + std::to_string(count)).c_str(), run)
      ->Iterations(1)
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

void addBesideBullet(const Heap& heap) {
  add(heap.name, heap.count, [heap](benchmark::State& state) { measure(heap, state); });
}

/** Times [us] per step of a heap, means over all. */
struct MeanTimes {
  double step = 0, solve = 0;
};

/** Adds the times of a turn to the mean over so many. */
void takeTurn(sim::Simulator* simulator, int turns, MeanTimes* mean) {
  const double start = wallSeconds();
  for (int i = 0; i < TURN; ++i) mean->solve += 1e6 * simulator->step().profile.seconds[SOLVE] / (TURN * turns);
  mean->step += 1e6 * (wallSeconds() - start) / (TURN * turns);
}

/** The same heap on one thread, on two, and on as many as the simulator chooses. */
void compareThreads(int count, benchmark::State& state) {
  constexpr std::array<const char*, 3> NAMES = {"one_thread", "two_threads", "chosen"};
  const std::array<dynamics::SolverSettings, 3> settings = {onThreads(1), onThreads(2), dynamics::SolverSettings()};
  std::vector<std::unique_ptr<sim::Simulator>> simulators;
  for (const dynamics::SolverSettings& solver : settings)
    simulators.push_back(std::make_unique<sim::Simulator>(heapInBin(count, heap_seed, solver), model::UriResolver(sharedPackages())));
  const int turns = static_cast<int>(std::lround(seconds_simulated / simulators[0]->config().time_step)) / TURN;
  std::array<MeanTimes, 3> mean;
  for (auto _ : state) {
    for (int turn = 0; turn < turns; ++turn)
      for (std::size_t i = 0; i < NAMES.size(); ++i) takeTurn(simulators[i].get(), turns, &mean[i]);
    state.SetIterationTime(1e-6 * mean[2].step);
  }
  static std::array<MeanTimes, 3> of_100;
  if (count == 100) of_100 = mean;
  for (std::size_t i = 0; i < NAMES.size(); ++i) {
    const std::string name = NAMES[i];
    state.counters[name + "_mean_us"] = mean[i].step;
    state.counters[name + "_solve_us"] = mean[i].solve;
    state.counters[name + "_solve_over_100"] = mean[i].solve / of_100[i].solve;
  }
  state.counters["speed_up"] = mean[0].step / mean[1].step;
  state.counters["speed_up_chosen"] = mean[0].step / mean[2].step;
  const std::uint64_t hash = simulators[0]->stateHash();
  state.counters["same_hash"] = simulators[1]->stateHash() == hash && simulators[2]->stateHash() == hash ? 1 : 0;
}

/** Takes an option out of the arguments. @param option as "--name=" @return its value, or `otherwise` */
double takeOption(const std::string& option, double otherwise, int* argc, char** argv) {
  double value = otherwise;
  int kept = 1;
  for (int i = 1; i < *argc; ++i) {
    if (std::strncmp(argv[i], option.c_str(), option.size()) == 0)
      value = std::atof(argv[i] + option.size());
    else
      argv[kept++] = argv[i];
  }
  *argc = kept;
  return value;
}

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  using namespace blem_sim;
  seconds_simulated = takeOption("--seconds=", seconds_simulated, &argc, argv);
  heap_seed = static_cast<int>(takeOption("--seed=", heap_seed, &argc, argv));
  for (const int size : {30, 100, 300, 1000}) addBesideBullet({"cubes", size, heapInBin, cubes});
  addBesideBullet({"spheres", 1000, spheresInBin, spheres});
  for (const int size : {100, 300, 1000}) add("threads", size, [size](benchmark::State& state) { compareThreads(size, state); });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
