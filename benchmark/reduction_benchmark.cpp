// Reduction of patches of contacts to k, step after step of a slow motion: processor time per call, median of the calls. Counters: the
// shortest call, the error of the wrenches' support function over 500 directions, memory allocated in a call. Arguments: Google
// Benchmark's.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <new>

#include "reduction/contact_patches.h"
#include "soak/figures.h"

namespace {
long allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace blem_sim {
namespace {

constexpr int CALLS = 400, STEPS = 2, WARM_UP = 20;  // two buffers of contacts, as in the simulation
constexpr double MOTION = 1e-5;                      // [m] from step to step

struct Patch {
  const char* name;
  reduction::Contacts (*make)(int count);
};

std::vector<reduction::Contacts> stepsOf(const reduction::Contacts& contacts) {
  std::vector<reduction::Contacts> steps(STEPS, contacts);
  reduction::Noise noise(5);
  for (reduction::Contacts& step : steps) {
    const Vector3 shift = MOTION * Vector3(noise(), noise(), noise());
    for (contact::Contact& contact : step) {
      contact.point += shift;
      contact.depth -= shift.dot(contact.normal_BA);
    }
  }
  return steps;
}

reduction::Contacts touching(const reduction::Contacts& contacts) {
  reduction::Contacts touching;
  for (const contact::Contact& contact : contacts) {
    if (contact.depth >= 0) touching.push_back(contact);
  }
  return touching;
}

void run(benchmark::State& state, const Patch& patch, int count, int k) {
  const std::vector<reduction::Contacts> steps = stepsOf(patch.make(count));
  reduction::Contacts reduced;
  reduction::ContactIds before;
  reduction::ReductionWorkspace workspace;
  std::vector<double> times;
  long allocated = 0;
  for (auto _ : state) {
    for (int call = -WARM_UP; call < CALLS; ++call) {
      const reduction::Contacts& contacts = steps[(call + WARM_UP) % STEPS];
      const long allocated_before = allocations;
      const double start = threadSeconds();
      reduction::reduceHull(contacts, k, before, &workspace, &reduced);
      const double time = threadSeconds() - start;
      allocated += call >= 0 ? allocations - allocated_before : 0;
      if (call >= 0) times.push_back(time);
      before.clear();
      for (const contact::Contact& contact : reduced) before.push_back(contact.id);
      std::sort(before.begin(), before.end());
    }
    std::sort(times.begin(), times.end());
    state.SetIterationTime(times[times.size() / 2]);
  }
  reduction::reduceHull(steps[0], k, {}, &workspace, &reduced);
  const reduction::SupportError error = reduction::supportError(touching(steps[0]), reduced);
  state.counters["min_us"] = 1e6 * times[0];
  state.counters["kept"] = static_cast<double>(reduced.size());
  state.counters["mean_error_%"] = 100 * error.mean;
  state.counters["max_error_%"] = 100 * error.max;
  state.counters["allocations"] = static_cast<double>(allocated);
}

const Patch PATCHES[] = {
    {"noisy", [](int count) { return reduction::noisyPatch(count); }},
    {"wall", [](int count) { return reduction::wallPatch(count); }},
    {"flat",
     [](int count) {
       return reduction::flatPatch(count, {0.3, -0.2, 1}, {0.5, 0.7, 0.1});
     }},
};

}  // namespace
}  // namespace blem_sim

int main(int argc, char** argv) {
  using namespace blem_sim;
  for (const Patch& patch : PATCHES) {
    for (const int count : {100, 1000, 5000, 10000}) {
      for (const int k : {20, 50}) {
        const std::string name = std::string("reduction/") + patch.name + "/" + std::to_string(count) + "/k" + std::to_string(k);
        benchmark::RegisterBenchmark(name.c_str(), [&patch, count, k](benchmark::State& state) { run(state, patch, count, k); })
            ->Unit(benchmark::kMicrosecond)
            ->UseManualTime()
            ->Iterations(1);
      }
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
