#include "run.h"

#include <fmt/format.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/simulator.h"
#include "blem_sim/sim/state_file.h"
#include "csv_table.h"
#include "overrides.h"
#include "run_record.h"

namespace blem_sim {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

SimulationConfig readConfig(const RunOptions& options) {
  YAML::Node root = loadYamlFile(options.config);
  for (const auto& [path, value] : options.settings) overrideSetting(&root, path, value);
  if (options.seed) overrideSetting(&root, "random_seed", std::to_string(*options.seed));
  return parseConfig(root, options.config, std::filesystem::absolute(options.config).parent_path().string());
}

/** Commands the trajectory to the first robot that has joints of its columns. */
void commandTrajectory(const std::string& file, Simulator* simulator, std::vector<std::string>* notes) {
  const auto& robots = simulator->robots();
  if (robots.empty()) throw InputError("--trajectory: the configuration has no robot");
  std::string first_refusal;
  for (std::size_t robot = 0; robot < robots.size(); ++robot) {
    std::vector<std::string> ignored;
    try {
      const JointTrajectory trajectory = loadTrajectoryCsv(file, robots[robot].joint_names, &ignored);
      simulator->commandTrajectory(static_cast<int>(robot), trajectory);
    } catch (const InputError& error) {
      if (first_refusal.empty()) first_refusal = error.what();
      continue;
    }
    if (!ignored.empty())
      notes->push_back(
          fmt::format("{}: columns that are no joints of {}, ignored: {}", file, robots[robot].name, fmt::join(ignored, ", ")));
    return;
  }
  throw InputError(first_refusal);
}

/** @throws InputError for what only a node can have */
void refuseTopics(const SimulationConfig& config) {
  for (const EnvironmentConfig& environment : config.environments)
    if (!environment.live.topic.empty())
      throw InputError(
          fmt::format("environments: {}: topic: {}: clouds come to blem_sim_node alone; save one as .pcd or .ply and give its uri",
                      environment.name, environment.live.topic));
}

/** Progress of a run as a line on a terminal; nothing elsewhere. */
class Progress {
 public:
  explicit Progress(std::uint64_t steps) : steps_(steps), on_terminal_(isatty(STDERR_FILENO) == 1) {}

  void show(std::uint64_t step, double time) {
    if (!on_terminal_ || secondsSince(shown_) < 0.2) return;
    shown_ = Clock::now();
    std::fprintf(stderr, "\r%3.0f %%  t = %.3f s ", 100.0 * static_cast<double>(step) / static_cast<double>(steps_), time);
  }
  void end(const std::vector<std::string>& notes) const {
    if (!on_terminal_) return;
    std::fputs("\r\033[K", stderr);
    for (const std::string& note : notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  }

 private:
  std::uint64_t steps_;
  bool on_terminal_;
  Clock::time_point shown_ = Clock::now();
};

/** Steps until the time is up or the state is not finite. */
bool stepThrough(const RunOptions& options, Simulator* simulator, RunRecord* record, Progress* progress) {
  std::unique_ptr<CsvTable> table;
  if (!options.csv.empty()) table = std::make_unique<CsvTable>(*simulator, options.csv, options.csv_rate);
  const auto steps = static_cast<std::uint64_t>(std::llround(options.duration / simulator->config().time_step));
  for (std::uint64_t step = 0; step < steps; ++step) {
    const StepReport& report = simulator->step();
    record->add(report);
    if (table) table->add(report);
    if (report.status & STATE_NOT_FINITE) return false;
    progress->show(step, report.time);
  }
  return true;
}

void writeReport(const RunOptions& options, const RunRecord& record, const RunTimes& times, const std::vector<std::string>& notes) {
  if (options.report.empty()) {
    record.write(times, notes, std::cout);
    return;
  }
  std::ofstream stream(options.report);
  record.write(times, notes, stream);
  stream.close();
  if (!stream) throw InputError(fmt::format("{}: cannot be written; check the folder", options.report));
}

}  // namespace

bool run(const RunOptions& options) {
  const SimulationConfig config = readConfig(options);
  refuseTopics(config);
  const LoadLog log{[](const std::string& line) { std::fprintf(stderr, "blem_sim_run: %s\n", line.c_str()); }};
  Simulator simulator(config, UriResolver(options.packages), log);
  std::vector<std::string> notes = simulator.notes();
  if (!options.load_state.empty()) simulator.restore(loadState(options.load_state));
  if (!options.trajectory.empty()) commandTrajectory(options.trajectory, &simulator, &notes);

  RunRecord record(simulator, options.stats_from);
  Progress progress(static_cast<std::uint64_t>(std::llround(options.duration / config.time_step)));
  const Clock::time_point start = Clock::now();
  const std::clock_t cpu_start = std::clock();
  const bool finite = stepThrough(options, &simulator, &record, &progress);
  const RunTimes times{static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC, secondsSince(start)};
  progress.end(notes);

  if (!options.save_state.empty()) saveState(simulator.save(), options.save_state);
  writeReport(options, record, times, notes);
  if (!finite) std::fprintf(stderr, "blem_sim_run: the state stopped being finite at t = %.6g s\n", simulator.time());
  return finite;
}

}  // namespace blem_sim
