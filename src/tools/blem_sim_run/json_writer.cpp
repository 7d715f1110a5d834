#include "json_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "utf8.h"

namespace blem_sim {

namespace {

const std::size_t INDENTED_LEVELS = 2;  ///< deeper ones stay on their line, so that a report reads as a table

const char* const REPLACEMENT = "\xef\xbf\xbd";  ///< U+FFFD

}  // namespace

std::string quotedJson(const std::string& text) {
  std::string quoted = "\"";
  for (std::size_t at = 0, length = 0; at < text.size(); at += std::max<std::size_t>(length, 1)) {
    const char letter = text[at];
    length = utf8Length(text, at);
    if (letter == '"' || letter == '\\')
      quoted += std::string("\\") + letter;
    else if (static_cast<unsigned char>(letter) < 0x20)
      quoted += fmt::format("\\u{:04x}", static_cast<int>(letter));
    else
      quoted += length == 0 ? REPLACEMENT : text.substr(at, length);
  }
  return quoted + "\"";
}

bool JsonWriter::onLinesOfItsOwn() const { return layout_ == Layout::INDENTED && empty_.size() <= INDENTED_LEVELS; }

void JsonWriter::newLine() {
  if (onLinesOfItsOwn()) stream_ << '\n' << std::string(2 * empty_.size(), ' ');
}

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (empty_.empty()) return;
  if (!empty_.back()) stream_ << (onLinesOfItsOwn() ? "," : ", ");
  empty_.back() = false;
  newLine();
}

void JsonWriter::open(char bracket) {
  separate();
  stream_ << bracket;
  empty_.push_back(true);
}

void JsonWriter::close(char bracket) {
  const bool indented = !empty_.back() && onLinesOfItsOwn();
  empty_.pop_back();
  if (indented) newLine();
  stream_ << bracket;
  if (empty_.empty()) stream_ << '\n';
}

void JsonWriter::boolean(bool truth) {
  separate();
  stream_ << (truth ? "true" : "false");
}

void JsonWriter::openObject() { open('{'); }
void JsonWriter::closeObject() { close('}'); }
void JsonWriter::openList() { open('['); }
void JsonWriter::closeList() { close(']'); }

JsonWriter& JsonWriter::key(const std::string& name) {
  separate();
  stream_ << quotedJson(name) << ": ";
  after_key_ = true;
  return *this;
}

void JsonWriter::value(double number) {
  separate();
  stream_ << (std::isfinite(number) ? fmt::format("{}", number) : "null");
}

void JsonWriter::value(std::uint64_t number) {
  separate();
  stream_ << fmt::format("{}", number);
}

void JsonWriter::value(const std::string& text) {
  separate();
  stream_ << quotedJson(text);
}

template <typename Values>
void JsonWriter::list(const Values& values) {
  separate();
  stream_ << '[';
  bool first = true;
  for (const auto& item : values) {
    if (!first) stream_ << ", ";
    first = false;
    after_key_ = true;  // the items of a short list stand on one line
    value(item);
  }
  stream_ << ']';
}

void JsonWriter::value(const std::vector<double>& numbers) { list(numbers); }
void JsonWriter::value(const std::vector<std::string>& texts) { list(texts); }
void JsonWriter::value(const Vector3& vector) { list(std::vector<double>{vector.x(), vector.y(), vector.z()}); }
void JsonWriter::value(const Quaternion& q) { list(std::vector<double>{q.x(), q.y(), q.z(), q.w()}); }

}  // namespace blem_sim
