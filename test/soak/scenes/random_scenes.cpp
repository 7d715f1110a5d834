// Random scenes of one second, each in a process of its own, so that none that dies or hangs takes the others with it.
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>

#include "support/random/eventful_scene.h"
#include "support/random/round_scene.h"

namespace blem_sim {
namespace {

struct Options {
  std::uint64_t first = 1, count = 20000;
  int jobs = 1;
  double duration = 1, patience = 60;  // [s] simulated; of processor time per scene
  bool verbose = false;
  bool round = false;     ///< scenes of things that roll
  bool eventful = false;  ///< models come and go, things are moved, states come back
  bool live = false;      ///< and live surfaces are exchanged
};

/** A scene that runs in another process. */
struct Runner {
  std::uint64_t seed;
  pid_t process;
  int pipe;
  double deadline;  // [s]
};

constexpr double LOADED = 20;  // wall time over processor time of a machine that has much else to do

SceneOutcome running;  // in a process of its own
int told_to = -1;

void tellHowFar(int) {
  std::strcpy(running.failure, "slow");
  _exit(write(told_to, &running, sizeof running) == sizeof running ? 0 : 1);
}

/** Runs a scene in its own process. */
[[noreturn]] void run(std::uint64_t seed, const Options& options, int pipe) {
  told_to = pipe;
  running.seed = seed;
  const auto patience = static_cast<rlim_t>(std::ceil(options.patience));
  const rlimit limit{patience, patience + 5};
  signal(SIGXCPU, tellHowFar);
  setrlimit(RLIMIT_CPU, &limit);
  try {
    const RandomScene scene = sceneOf(seed, options.round);
    if (options.eventful)
      EventfulScene(scene, seed, options.live, &running).run(options.duration);
    else
      runRandomScene(scene, options.duration, &running);
  } catch (const std::exception& error) {
    running.fail("refused", error.what());
  }
  _exit(write(pipe, &running, sizeof running) == sizeof running ? 0 : 1);
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Runner start(std::uint64_t seed, const Options& options) {
  int ends[2];
  if (pipe(ends) != 0) std::abort();
  std::fflush(stdout);
  const pid_t process = fork();
  if (process < 0) std::abort();
  if (process > 0) {
    close(ends[1]);
    return {seed, process, ends[0], now() + LOADED * options.patience};
  }
  close(ends[0]);
  run(seed, options, ends[1]);
}

/** Outcome of a runner whose pipe has something to read or whose time is over. */
SceneOutcome finish(const Runner& runner, bool hangs) {
  SceneOutcome outcome;
  if (hangs) kill(runner.process, SIGKILL);
  const bool told = !hangs && read(runner.pipe, &outcome, sizeof outcome) == sizeof outcome;
  close(runner.pipe);
  int status = 0;
  waitpid(runner.process, &status, 0);
  std::filesystem::remove_all(sim::sceneFolderOf(runner.process));
  if (!told) {
    outcome = SceneOutcome();
    outcome.seed = runner.seed;
    outcome.fail(hangs ? "hangs" : "died", hangs ? "killed" : fmt::format("signal {}", WIFSIGNALED(status) ? WTERMSIG(status) : 0));
  }
  return outcome;
}

/** Counts of all scenes. */
class Summary {
 public:
  void add(const SceneOutcome& outcome) {
    ++scenes_;
    steps_ += outcome.steps;
    for (int bit = 0; bit < STATUS_BITS; ++bit) {
      bits_[bit] += outcome.bits[bit];
      scenes_with_[bit] += outcome.bits[bit] > 0;
    }
    if (outcome.failed()) ++failures_[outcome.failure];
    if (outcome.worst_step > worst_step_) {
      worst_step_ = outcome.worst_step;
      worst_seed_ = outcome.seed;
    }
    if (outcome.of_energy > 0.01) ++gaining_;
    if (outcome.of_energy > most_gained_) {
      most_gained_ = outcome.of_energy;
      gaining_seed_ = outcome.seed;
    }
  }
  void print() const {
    int failed = 0;
    for (const auto& [kind, count] : failures_) failed += count;
    std::printf("%d scenes, %ld steps, %d failed\n", scenes_, steps_, failed);
    for (const auto& [kind, count] : failures_) std::printf("  %-20s %6d\n", kind.c_str(), count);
    for (int bit = 0; bit < STATUS_BITS; ++bit)
      std::printf("  %-20s %8ld steps (%.4f %%) in %d scenes\n", sim::STEP_STATUS[bit].name, bits_[bit],
                  100.0 * static_cast<double>(bits_[bit]) / static_cast<double>(std::max(1L, steps_)), scenes_with_[bit]);
    std::printf("  gained over 1 %% of the energy that moved, told or not: %d scenes; most: x %.3g, seed %llu\n", gaining_, most_gained_,
                static_cast<unsigned long long>(gaining_seed_));
    std::printf("  worst step: %.1f ms of processor time, seed %llu\n", 1e3 * worst_step_, static_cast<unsigned long long>(worst_seed_));
  }
  bool failed() const { return !failures_.empty(); }

 private:
  int scenes_ = 0, gaining_ = 0;
  long steps_ = 0;
  std::array<long, STATUS_BITS> bits_{};
  std::array<int, STATUS_BITS> scenes_with_{};
  std::map<std::string, int> failures_;
  double worst_step_ = 0, most_gained_ = 0;
  std::uint64_t worst_seed_ = 0, gaining_seed_ = 0;
};

void tell(const SceneOutcome& outcome, const Options& options) {
  if (!outcome.failed() && !options.verbose) return;
  const RandomScene scene = sceneOf(outcome.seed, options.round);
  std::printf("seed %-6llu %-18s %s | %s | gained %.3g J (x %.2g), worst step %.1f ms", static_cast<unsigned long long>(outcome.seed),
              outcome.failed() ? outcome.failure : "ok", outcome.details, scene.description.c_str(), outcome.gained, outcome.of_energy,
              1e3 * outcome.worst_step);
  for (int bit = 0; bit < STATUS_BITS; ++bit)
    if (outcome.bits[bit] > 0) std::printf(" %s:%d", sim::STEP_STATUS[bit].name, outcome.bits[bit]);
  if (outcome.failed())
    std::printf(" | scripts/validate_random_scenes%s%s --seed %llu", options.round ? " --round" : "",
                options.live       ? " --live"
                : options.eventful ? " --eventful"
                                   : "",
                static_cast<unsigned long long>(outcome.seed));
  std::printf("\n");
  std::fflush(stdout);
}

Summary runAll(const Options& options) {
  Summary summary;
  std::vector<Runner> runners;
  std::uint64_t next = options.first;
  const std::uint64_t end = options.first + options.count;
  while (next < end || !runners.empty()) {
    while (next < end && static_cast<int>(runners.size()) < options.jobs) runners.push_back(start(next++, options));
    std::vector<pollfd> pipes;
    for (const Runner& runner : runners) pipes.push_back({runner.pipe, POLLIN, 0});
    poll(pipes.data(), pipes.size(), 100);
    for (std::size_t i = runners.size(); i-- > 0;) {
      const bool ended = pipes[i].revents != 0, hangs = !ended && now() > runners[i].deadline;
      if (!ended && !hangs) continue;
      const SceneOutcome outcome = finish(runners[i], hangs);
      runners.erase(runners.begin() + static_cast<long>(i));
      summary.add(outcome);
      tell(outcome, options);
    }
  }
  return summary;
}

}  // namespace
}  // namespace blem_sim

int main(int count, char** words) {
  blem_sim::Options options;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const auto value = [&] { return i + 1 < count ? words[++i] : ""; };
    if (word == "--first")
      options.first = std::strtoull(value(), nullptr, 10);
    else if (word == "--count")
      options.count = std::strtoull(value(), nullptr, 10);
    else if (word == "--jobs")
      options.jobs = std::max(1, std::atoi(value()));
    else if (word == "--duration")
      options.duration = std::atof(value());
    else if (word == "--patience")
      options.patience = std::atof(value());
    else if (word == "--verbose")
      options.verbose = true;
    else if (word == "--round")
      options.round = true;
    else if (word == "--eventful" || word == "--live") {
      options.eventful = true;
      options.live = word == "--live";
    } else {
      std::fprintf(stderr, "%s: unknown argument '%s'\n", words[0], words[i]);
      return 2;
    }
  }
  const blem_sim::Summary summary = blem_sim::runAll(options);
  summary.print();
  return summary.failed() ? 1 : 0;
}
