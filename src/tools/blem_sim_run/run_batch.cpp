#include "run_batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "batch_file.h"
#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"
#include "json_writer.h"
#include "run.h"

namespace blem_sim {

namespace {

const std::array<ExitStatus, 4> BEST_FIRST = {FINISHED, NOT_FINITE, BAD_INPUT, FAILED};

ExitStatus worse(ExitStatus a, ExitStatus b) {
  const auto rank = [](ExitStatus status) { return std::find(BEST_FIRST.begin(), BEST_FIRST.end(), status); };
  return rank(a) < rank(b) ? b : a;
}

/** Lines of results in a file or on standard output, each there as soon as its run has ended. */
class BatchResults {
 public:
  /** @param file empty: standard output @throws InputError if it cannot be written */
  explicit BatchResults(const std::string& file) : file_(file) {
    if (file.empty()) return;
    stream_.open(file);
    if (!stream_) throw InputError(fmt::format("{}: cannot be written; check the folder", file));
  }
  /** @throws InputError if the line is not all written */
  void add(const std::string& line) {
    std::ostream& stream = file_.empty() ? std::cout : stream_;
    stream << line << std::flush;
    if (!stream)
      throw InputError(
          fmt::format("{}: results could not all be written; make room on its disk", file_.empty() ? "standard output" : file_));
  }

 private:
  std::string file_;
  std::ofstream stream_;
};

/** Line of a run that was refused, also told on the standard error stream. */
std::string refusalLine(const std::string& name, const std::string& why) {
  std::fprintf(stderr, "blem_sim_run: %s\n", geometry::oneLine(name + ": " + why).c_str());
  std::ostringstream line;
  JsonWriter json(line, JsonWriter::Layout::ONE_LINE);
  json.openObject();
  json.key("name").value(name);
  json.key("error").value(why);
  json.closeObject();
  return line.str();
}

ExitStatus runLine(const BatchRun& line, BatchSide* batch, std::string* result) {
  const std::string& name = line.options.name;
  try {
    if (!line.refusal.empty()) throw InputError(line.refusal);
    std::ostringstream report;
    batch->result = &report;
    const RunEnd end = run(line.options, batch);
    *result = report.str();
    return end == RunEnd::NOT_FINITE ? NOT_FINITE : FINISHED;
  } catch (const InputError& error) {
    *result = refusalLine(name, error.what());
    return BAD_INPUT;
  } catch (const std::exception& error) {
    *result = refusalLine(name, error.what());
    return FAILED;
  }
}

}  // namespace

ExitStatus runBatch(const RunOptions& options) {
  const std::vector<BatchRun> lines = readBatch(options);
  BatchResults results(options.report);
  const EndSignal signal;
  BatchSide batch{nullptr, &signal, nullptr};
  ExitStatus status = FINISHED;
  for (const BatchRun& line : lines) {
    if (signal.number() != 0) break;
    std::string result;
    status = worse(status, runLine(line, &batch, &result));
    results.add(result);
  }
  signal.passOn();
  return status;
}

}  // namespace blem_sim
