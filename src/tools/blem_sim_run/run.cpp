#include "run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/sim/simulator.h"
#include "blem_sim/sim/state_file.h"
#include "csv_table.h"
#include "numbers/nearest_name.h"
#include "run_record.h"
#include "run_setup.h"
#include "stop_expression.h"

namespace blem_sim {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/** Progress of a run as a line on a terminal; nothing elsewhere. */
class Progress {
 public:
  /** @param name of a run of a batch, or empty */
  Progress(std::uint64_t steps, const std::string& name)
      : steps_(steps), label_(name.empty() ? "" : sim::shownName(name) + " "), on_terminal_(isatty(STDERR_FILENO) == 1) {}

  void show(std::uint64_t step, double time) {
    if (!on_terminal_ || secondsSince(shown_) < 0.2) return;
    shown_ = Clock::now();
    std::fprintf(stderr, "\r%s%3.0f %%  t = %.3f s ", label_.c_str(), 100.0 * static_cast<double>(step) / static_cast<double>(steps_),
                 time);
  }
  void end(const std::vector<std::string>& notes) const {
    if (!on_terminal_) return;
    std::fputs("\r\033[K", stderr);
    for (const std::string& note : notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  }

 private:
  std::uint64_t steps_;
  std::string label_;
  bool on_terminal_;
  Clock::time_point shown_ = Clock::now();
};

/** Observers of a run, each called after every step. */
struct Observers {
  RunRecord* record;
  CsvTable* table;  ///< null without --csv
  StopConditions* stops;
  Progress* progress;
  const EndSignal* signal;  ///< null: none is taken
};

/** Steps until the time is up, a stop holds, a signal came or the state is not finite. */
RunEnd stepThrough(std::uint64_t steps, sim::Simulator* simulator, const Observers& observers) {
  for (std::uint64_t step = 0; step < steps; ++step) {
    if (observers.signal && observers.signal->number() != 0) {
      observers.record->interrupt(observers.signal->name());
      return RunEnd::INTERRUPTED;
    }
    const sim::StepReport& report = simulator->step();
    observers.record->add(report);
    if (observers.table) observers.table->add(report);
    if ((report.status & sim::STATE_NOT_FINITE) != 0) return RunEnd::NOT_FINITE;
    observers.progress->show(step, report.time);
    if (const std::string* stop = observers.stops->met(report)) {
      observers.record->stop(*stop);
      return RunEnd::FINISHED;
    }
  }
  return RunEnd::FINISHED;
}

/** Goes on from a saved state, and notes what it has brought along in place of what was asked for. */
void loadState(const RunOptions& options, sim::Simulator* simulator, std::vector<std::string>* notes) {
  simulator->restore(sim::loadState(options.load_state));
  const Vector3 &asked = simulator->config().gravity, &g = simulator->gravity();
  if (g != asked)
    notes->push_back(fmt::format("gravity: [{}, {}, {}] of {} holds, not the configuration's", g.x(), g.y(), g.z(), options.load_state));
  if (options.seed) notes->push_back(fmt::format("random_seed: the numbers of {} go on, not those of --seed", options.load_state));
}

/** Writes the report to the file that options name, or to standard output. */
void writeReport(const RunOptions& options, const RunRecord& record, const RunFacts& facts) {
  if (options.report.empty()) {
    JsonWriter json(std::cout);
    record.write(facts, json);
    if (!std::cout.flush()) throw InputError("the report on standard output could not all be written; make room on its disk");
    return;
  }
  std::ofstream stream(options.report);
  JsonWriter json(stream);
  record.write(facts, json);
  stream.close();
  if (!stream) throw InputError(fmt::format("{}: cannot be written; check the folder", options.report));
}

sim::SimulationConfig configOf(const RunOptions& options) {
  std::vector<std::pair<std::string, std::string>> settings = options.settings;
  if (options.seed) settings.emplace_back("random_seed", std::to_string(*options.seed));
  return readConfig(options.config, settings);
}

void tell(const std::string& line) { std::fprintf(stderr, "blem_sim_run: %s\n", line.c_str()); }

}  // namespace

RunEnd run(const RunOptions& options, BatchSide* batch) {
  const sim::SimulationConfig config = configOf(options);
  std::unique_ptr<sim::Simulator> alone;
  std::unique_ptr<sim::Simulator>& place = batch ? batch->last : alone;
  place = std::make_unique<sim::Simulator>(config, model::UriResolver(options.packages), sim::LoadLog{tell}, place.get());
  sim::Simulator& simulator = *place;
  RunFacts facts{options.name, {}, simulator.notes()};
  if (!options.load_state.empty()) loadState(options, &simulator, &facts.notes);
  if (!options.trajectory.empty()) commandTrajectory(options.trajectory, &simulator, &facts.notes);

  StopConditions stops(simulator, options.stops);
  RunRecord record(simulator, options.stats_from);
  std::unique_ptr<CsvTable> table;
  if (!options.csv.empty()) table = std::make_unique<CsvTable>(simulator, options.csv, options.csv_rate);
  const auto steps = static_cast<std::uint64_t>(std::llround(options.duration / config.time_step));
  Progress progress(steps, options.name);
  const Clock::time_point start = Clock::now();
  const std::clock_t cpu_start = std::clock();
  const RunEnd end = stepThrough(steps, &simulator, {&record, table.get(), &stops, &progress, batch ? batch->signal : nullptr});
  facts.times = {static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC, secondsSince(start)};
  progress.end(facts.notes);

  if (!options.save_state.empty() && end != RunEnd::INTERRUPTED) sim::saveState(simulator.save(), options.save_state);
  if (!batch || !options.report.empty()) writeReport(options, record, facts);
  if (table) table->close();
  if (batch) {
    JsonWriter json(*batch->result, JsonWriter::Layout::ONE_LINE);
    record.write(facts, json);
  }
  if (end == RunEnd::NOT_FINITE)
    tell(fmt::format("{}the state stopped being finite at t = {:.6g} s", batch ? sim::shownName(options.name) + ": " : "",
                     simulator.time()));
  return end;
}

}  // namespace blem_sim
