// Mutations of files, read and simulated in child processes: each is taken or refused in one line, within 10 s and 4 GiB.
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <set>

#include "blem_sim/geometry/far_origin.h"
#include "blem_sim/sim/simulator.h"
#include "fuzz/damaged_bytes.h"
#include "fuzz/model_targets.h"
#include "fuzz/seeds.h"

/** Memory beyond the limit ends the child with a report; little of what was freed is kept, and short call stacks, since files are many. */
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "hard_rss_limit_mb=4096:detect_leaks=0:quarantine_size_mb=16:malloc_context_size=5";
}

namespace blem_sim {
namespace {

constexpr int PATIENCE = 10;            // [s] of processor time
constexpr int MUTATIONS_A_CHILD = 200;  // no more is lost when one of them ends it
constexpr int SIMULATED = 10;           // each tenth mutation is simulated, too
constexpr int STEPS = 10;

/** Memory that a child shares with its parent. */
struct Progress {
  int mutation;  ///< that the child is at
  int loaded, refused;
  double slowest;  ///< [s] of processor time
  int slowest_mutation;
  int simulated;
};

double processorTime() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/** The mutation of that number; number 0 is the file as it is. */
std::string mutationOf(const std::string& bytes, int number) {
  std::mt19937 random(static_cast<unsigned>(number));
  if (number == 0) return bytes;
  return number % 3 == 0 ? withAbsurdNumber(bytes, &random) : damaged(bytes, &random);
}

/** A body falls onto the middle of the file's mesh or cloud. */
void simulate(const std::string& file, const Box& extents) {
  sim::SimulationConfig config;
  config.environments.resize(1);
  config.environments[0].name = "ground";
  config.environments[0].uri = file;
  sim::ObjectConfig body;
  body.name = "body";
  body.uri = std::string(BLEM_SIM_SOURCE_DIR) + "/meshes/cube_10cm.stl";
  body.mass = 1;
  Vector3 place = extents.center();
  place.z() = extents.max().z() + 0.06;
  body.X_WO = makePose(place.cwiseMax(-geometry::FARTHEST_PLACE).cwiseMin(geometry::FARTHEST_PLACE));
  body.linear_velocity = {0, 0, -10};
  config.objects = {body};
  sim::Simulator simulator(config, model::UriResolver());
  for (int i = 0; i < STEPS; ++i)
    if (simulator.step().status & sim::STATE_NOT_FINITE) tellFinding("a state that is not finite");
}

/** Lets SIGPROF end this process unless it is called again within that processor time, or SIGALRM after six times as long. */
void setPatience() {
  itimerval timer{};
  timer.it_value.tv_sec = PATIENCE;
  setitimer(ITIMER_PROF, &timer, nullptr);
  alarm(6 * PATIENCE);
}

void take(const std::string& file, bool simulated, Progress* progress) {
  bool loaded = false;
  Box extents;
  expectReadOrRefused([&] {
    extents = model::loadSurface(file).report.extents;
    loaded = true;
  });
  ++(loaded ? progress->loaded : progress->refused);
  if (!loaded || !simulated) return;
  expectReadOrRefused([&] { simulate(file, extents); });
  ++progress->simulated;
}

[[noreturn]] void runChild(const std::string& bytes, const std::string& file, int first, int end, Progress* progress) {
  for (int i = first; i < end; ++i) {
    progress->mutation = i;
    setPatience();
    std::ofstream(file, std::ios::binary) << mutationOf(bytes, i);
    const double begun = processorTime();
    take(file, i % SIMULATED == 0, progress);
    const double taken = processorTime() - begun;
    if (taken > progress->slowest) progress->slowest = taken, progress->slowest_mutation = i;
  }
  _exit(0);
}

class DamagedFile {
 public:
  DamagedFile(const std::string& file, const std::string& folder)
      : name_(std::filesystem::path(file).filename().string()),
        bytes_(bytesOf(file)),
        place_(folder + "/" + std::to_string(getpid()) + "_" + name_),
        folder_(folder) {
    progress_ = static_cast<Progress*>(mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    *progress_ = Progress();
  }
  DamagedFile(const DamagedFile&) = delete;
  DamagedFile& operator=(const DamagedFile&) = delete;
  ~DamagedFile() {
    munmap(progress_, sizeof(Progress));
    std::filesystem::remove(place_);
  }

  /** @return number of findings */
  int run(int first, int count) {
    int findings = 0;
    for (int next = first; next < first + count;) {
      const int end = std::min(next + MUTATIONS_A_CHILD, first + count);
      const bool well = endsWell(next, end);
      next = well ? end : progress_->mutation + 1;
      findings += well ? 0 : 1;
    }
    std::printf("%-36s %6d loaded, %6d refused, %5d simulated; slowest %.2f s (mutation %d), largest %ld MB; findings: %d\n", name_.c_str(),
                progress_->loaded, progress_->refused, progress_->simulated, progress_->slowest, progress_->slowest_mutation,
                largest_ / 1024, findings);
    std::fflush(stdout);
    return findings;
  }

 private:
  /** Whether a child takes these mutations to their end. */
  bool endsWell(int first, int end) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) runChild(bytes_, place_, first, end, progress_);
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    largest_ = std::max(largest_, usage.ru_maxrss);
    const bool well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (!well) keep(status);
    return well;
  }

  void keep(int status) {
    const std::string kept = fmt::format("{}/finding_{}_{}", folder_, progress_->mutation, name_);
    std::filesystem::copy_file(place_, kept, std::filesystem::copy_options::overwrite_existing);
    const std::string end = WIFSIGNALED(status) ? fmt::format("signal {}", WTERMSIG(status)) : fmt::format("exit {}", WEXITSTATUS(status));
    std::printf("%s: mutation %d: %s; kept as %s\n", name_.c_str(), progress_->mutation, end.c_str(), kept.c_str());
  }

  const std::string name_, bytes_, place_, folder_;
  Progress* progress_;
  long largest_ = 0;  // [kB] resident
};

}  // namespace
}  // namespace blem_sim

/** Usage: soak_damaged FOLDER FIRST COUNT FILE ...: findings are kept in the folder. */
int main(int argc, char** argv) {
  if (argc < 5) return std::fprintf(stderr, "usage: soak_damaged FOLDER FIRST COUNT FILE ...\n"), 2;
  int findings = 0;
  for (int i = 4; i < argc; ++i) findings += blem_sim::DamagedFile(argv[i], argv[1]).run(std::atoi(argv[2]), std::atoi(argv[3]));
  return findings > 0 ? 1 : 0;
}
