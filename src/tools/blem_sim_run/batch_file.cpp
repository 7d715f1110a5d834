#include "batch_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <system_error>

#include "blem_sim/geometry/input_error.h"
#include "json_value.h"
#include "numbers/nearest_name.h"

namespace blem_sim {

namespace {

using Kind = JsonValue::Kind;

const std::size_t MOST_BYTES = 64u << 20;
const char* const BYTE_ORDER_MARK = "\xef\xbb\xbf";
const char* const EXAMPLE = R"({"name": "a", "seed": 1})";

/** A key of a line: its value goes where the option's goes. */
struct Field {
  const char* key;
  const char* option;  ///< "": not an option of the command line
  Kind kind;
};
const std::array<Field, 13> FIELDS = {{{"name", "", Kind::TEXT},
                                       {"config", "", Kind::TEXT},
                                       {"set", "--set", Kind::OBJECT},
                                       {"stop", "--stop", Kind::OBJECT},
                                       {"seed", "--seed", Kind::NUMBER},
                                       {"duration", "--duration", Kind::NUMBER},
                                       {"trajectory", "--trajectory", Kind::TEXT},
                                       {"stats_from", "--stats-from", Kind::NUMBER},
                                       {"csv", "--csv", Kind::TEXT},
                                       {"csv_rate", "--csv-rate", Kind::NUMBER},
                                       {"report", "--report", Kind::TEXT},
                                       {"load_state", "--load-state", Kind::TEXT},
                                       {"save_state", "--save-state", Kind::TEXT}}};

const Field* fieldOf(const std::string& key) {
  const auto* const found = std::find_if(FIELDS.begin(), FIELDS.end(), [&](const Field& field) { return field.key == key; });
  return found == FIELDS.end() ? nullptr : found;
}

void requireKind(const std::string& where, const JsonValue& value, Kind kind) {
  if (value.kind == kind) return;
  throw InputError(fmt::format("{}: must be {}, not {}{}", where, kindInWords(kind), kindInWords(value.kind),
                               value.kind == Kind::NOTHING ? "; leave the key out" : ""));
}

std::string contentsOf(const std::string& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) throw InputError(fmt::format("{}: is a folder; give a file of runs in it", file));
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{}: cannot be read; check the path", file));
  std::string text(MOST_BYTES + 1, '\0');
  stream.read(&text[0], static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > MOST_BYTES) throw InputError(fmt::format("{}: has more than {} MB; split it", file, MOST_BYTES >> 20));
  if (text.compare(0, std::char_traits<char>::length(BYTE_ORDER_MARK), BYTE_ORDER_MARK) == 0) text.erase(0, 3);
  if (text.empty()) throw InputError(fmt::format("{}: is empty; write a JSON object for each run on a line, as {}", file, EXAMPLE));
  return text;
}

/** Takes {NAME: VALUE}: a parameter's value may be any JSON, a stop's is a string. */
void takePairs(const std::string& where, const Field& field, const JsonValue& value,
               std::vector<std::pair<std::string, std::string>>* pairs) {
  for (const auto& [name, member] : value.members) {
    const std::string place = fmt::format("{}: {}", where, sim::shownName(name));
    if (name.empty()) throw InputError(fmt::format("{}: a key is empty; give it a name", where));
    const bool stop = field.key == std::string("stop");
    if (stop) requireKind(place, member, Kind::TEXT);
    pairs->emplace_back(name, stop ? member.text : jsonText(member));
  }
}

/** Reads line after line, and knows what earlier lines have taken. */
class BatchReader {
 public:
  /** @throws InputError if the results would take the batch's place */
  explicit BatchReader(const RunOptions& common) : common_(common) {
    claims_[placeOf(common.batch)] = "the batch itself";
    claim("--report", common.report, "where the results go");
  }

  BatchRun read(const std::string& line) {
    ++number_;
    BatchRun run{common_, ""};
    run.options.report.clear();  // the command line's is the file of results
    run.options.name = fmt::format("run_{}", number_);
    try {
      take(line, &run.options);
    } catch (const InputError& error) {
      run.refusal = fmt::format("{}:{}: {}", common_.batch, number_, error.what());
    }
    return run;
  }
  bool foundObject() const { return found_object_; }

 private:
  void take(const std::string& line, RunOptions* options) {
    if (line.find_first_not_of(" \t\r") == std::string::npos)
      throw InputError("is empty; take the line out, or write {} for a run with the command line's options");
    const JsonValue value = parseJson(line);
    if (value.kind != Kind::OBJECT) throw InputError(fmt::format("is {}; write an object, as {}", kindInWords(value.kind), EXAMPLE));
    found_object_ = true;
    for (const auto& [key, member] : value.members)  // first, so that other refusals carry it
      if (key == "name") takeField(*fieldOf(key), member, options);
    for (const auto& [key, member] : value.members) {
      const Field* const field = fieldOf(key);
      if (!field) refuseKey(key);
      takeField(*field, member, options);
    }
    const std::string line_number = fmt::format("line {}", number_);
    const auto [holder, is_new] = names_.emplace(options->name, line_number);
    if (!is_new) throw InputError(fmt::format("name: '{}' is the name of {}; give another", sim::shownName(options->name), holder->second));
    if (options->config.empty()) throw InputError("config is missing; give it here, or CONFIG.yaml on the command line");
    const std::string holder_of_files = "written by " + line_number;
    claim("csv", options->csv, holder_of_files);
    claim("report", options->report, holder_of_files);
    claim("save_state", options->save_state, holder_of_files);
  }

  void takeField(const Field& field, const JsonValue& value, RunOptions* options) const {
    const std::string where = field.key;
    if (where == "stop" && value.kind == Kind::LIST) {
      for (const JsonValue& item : value.items) {
        requireKind(where, item, Kind::TEXT);
        runOptionTable().at(field.option)(*options, where, item.text);
      }
      return;
    }
    requireKind(where, value, field.kind);
    if (where == "name" || where == "config")
      (where == "name" ? options->name : options->config) = textOf(where, value.text);
    else if (field.kind == Kind::OBJECT)
      takePairs(where, field, value, where == "set" ? &options->settings : &options->stops);
    else
      runOptionTable().at(field.option)(*options, where, value.text);
  }

  [[noreturn]] static void refuseKey(const std::string& key) {
    std::vector<std::string> known;
    for (const Field& field : FIELDS) known.emplace_back(field.key);
    throw InputError(fmt::format("'{}' is unknown; the nearest known key is '{}'", sim::shownName(key), sim::nearestName(key, known)));
  }

  void claim(const std::string& key, const std::string& file, const std::string& holder) {
    std::error_code ignored;
    const auto status = std::filesystem::status(file, ignored);
    const bool shared = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);  // /dev/null, a pipe
    if (file.empty() || shared) return;
    const auto [taken, is_new] = claims_.emplace(placeOf(file), holder);
    if (!is_new) throw InputError(fmt::format("{}: {} is {}; give another file", key, sim::shownName(file), taken->second));
  }

  /** The file by a path that does not depend on how it is written. */
  static std::string placeOf(const std::string& file) {
    std::error_code failed;
    const std::filesystem::path place = std::filesystem::weakly_canonical(std::filesystem::absolute(file, failed), failed);
    return failed ? file : place.string();
  }

  const RunOptions& common_;
  int number_ = 0;
  bool found_object_ = false;
  std::map<std::string, std::string> names_, claims_;  ///< by name or place: who has it
};

}  // namespace

std::vector<BatchRun> readBatch(const RunOptions& options) {
  std::istringstream text(contentsOf(options.batch));
  BatchReader reader(options);
  std::vector<BatchRun> runs;
  for (std::string line; std::getline(text, line);) runs.push_back(reader.read(line));
  if (!reader.foundObject()) throw InputError(fmt::format("{}; each line of a batch is a JSON object, as {}", runs[0].refusal, EXAMPLE));
  return runs;
}

}  // namespace blem_sim
