#include "config/yaml_text.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstddef>

namespace blem_sim::sim {
namespace {

constexpr char TAKEN_FOR_END = 4;

bool isOneOf(const char* letters, char c) { return c != '\0' && std::string(letters).find(c) != std::string::npos; }

/** Follows a text letter by letter: quotes, comments, brackets and braces that are open. */
class Place {
 public:
  void take(char c) {
    const bool starts = isOneOf(" \t\r\n[{,:", last_);
    if (escaped_) {
      escaped_ = false;
    } else if (comment_) {
      comment_ = c != '\n';
    } else if (quote_ != '\0') {
      escaped_ = quote_ == '"' && c == '\\';
      if (c == quote_) quote_ = '\0';
    } else if ((starts && isOneOf("\"'", c)) || (last_ == '\'' && c == '\'')) {  // the last one: a quote within single ones
      quote_ = c;
    } else if (isOneOf(" \t\r\n", last_) && c == '#') {
      comment_ = true;
    } else if ((starts || depth_ > 0) && isOneOf("[{", c)) {
      ++depth_;
    } else if (depth_ > 0 && isOneOf("]}", c)) {
      --depth_;
    }
    last_ = c;
  }
  /** Whether a list or a map in brackets or braces goes on here, outside of quotes and comments. */
  bool isInside() const { return depth_ > 0 && quote_ == '\0' && !comment_; }

 private:
  char last_ = '\n', quote_ = '\0';
  bool comment_ = false, escaped_ = false;
  int depth_ = 0;
};

void refuseControls(const std::string& text) {
  const auto end = std::find(text.begin(), text.end(), TAKEN_FOR_END);
  if (end == text.end()) return;
  YAML::Mark mark;
  mark.line = static_cast<int>(std::count(text.begin(), end, '\n'));
  throw YAML::ParserException(mark, "the control character 4 is in it; take it out");
}

}  // namespace

std::string endingYaml(const std::string& text) {
  refuseControls(text);
  std::string ending;
  ending.reserve(text.size() + 1);
  Place place;
  for (std::size_t i = 0; i < text.size(); ++i) {
    place.take(text[i]);
    ending += text[i];
    const bool hangs = i + 1 == text.size() || text[i + 1] == ']';
    if (text[i] == ':' && hangs && place.isInside()) ending += ' ';
  }
  return ending;
}

}  // namespace blem_sim::sim
