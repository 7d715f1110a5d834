#include "config/yaml_size.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <sstream>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"
#include "config/scene_limits.h"

namespace blem_sim::sim {
namespace {

constexpr std::size_t SHORTEST_ENTRY = 2;  // [characters], as in [1,2,3]

/** Counts the entries of the lists and maps that are open. */
class EntryCounter : public YAML::EventHandler {
 public:
  explicit EntryCounter(const std::string& file) : file_(file) {}

  void OnDocumentStart(const YAML::Mark& mark) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(mark, ""); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(mark, ""); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& value) override {
    add(mark, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YAML::EmitterStyle::value style) override {
    add(mark, "");
    open_.push_back({false, 0, ""});
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YAML::EmitterStyle::value style) override {
    add(mark, "");
    open_.push_back({true, 0, ""});
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  /** A list, or a map: keys and values in turn. */
  struct Level {
    bool map;
    std::size_t nodes;
    std::string key;  // of a map, the last one

    std::size_t entries() const { return map ? (nodes + 1) / 2 : nodes; }
  };

  void add(const YAML::Mark& mark, const std::string& text) {
    if (open_.empty()) return;
    Level& level = open_.back();
    if (level.map && level.nodes % 2 == 0) level.key = text;
    ++level.nodes;
    if (level.entries() > MOST_MODELS) refuse(mark);
  }
  [[noreturn]] void refuse(const YAML::Mark& mark) const {
    std::string path;
    for (std::size_t i = 0; i + 1 < open_.size(); ++i)
      path += open_[i].map ? (path.empty() ? "" : ".") + open_[i].key : fmt::format("[{}]", open_[i].nodes - 1);
    throw InputError(geometry::oneLine(fmt::format("{}:{}: {}{}has more than the {} entries that are simulated; give fewer", file_,
                                                   mark.line + 1, path, path.empty() ? "" : ": ", MOST_MODELS)));
  }

  const std::string& file_;
  std::vector<Level> open_;
};

}  // namespace

void checkYamlSize(const std::string& text, const std::string& file) {
  if (text.size() < SHORTEST_ENTRY * MOST_MODELS) return;
  std::istringstream stream(text);
  EntryCounter counter(file);
  YAML::Parser(stream).HandleNextDocument(counter);
}

}  // namespace blem_sim::sim
