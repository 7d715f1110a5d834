#include "json_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "blem_sim/geometry/input_error.h"
#include "json_writer.h"
#include "numbers/nearest_name.h"
#include "utf8.h"

namespace blem_sim {

namespace {

const int MOST_NESTED = 100;
const char* const NUMERALS = "0123456789";
const char* const WORD_ENDS = " \t\r\n,:[]{}\"";
const std::string ESCAPES = "\"\\/bfnrt", ESCAPED = "\"\\/\b\f\n\r\t";  ///< letters behind a backslash, and their meaning

bool isLowSurrogate(std::uint32_t unit) { return unit >= 0xdc00 && unit < 0xe000; }
bool isHighSurrogate(std::uint32_t unit) { return unit >= 0xd800 && unit < 0xdc00; }

/** Recursive descent. */
class JsonParser {
 public:
  explicit JsonParser(const std::string& text) : text_(text) {}

  JsonValue document() {
    const JsonValue root = value();
    skipSpace();
    if (at_ < text_.size()) refuse("more than one value; give each a line of its own");
    return root;
  }

 private:
  [[noreturn]] void refuse(const std::string& fault) const { throw InputError(fmt::format("letter {}: {}", at_ + 1, fault)); }
  [[noreturn]] void refuseNext(const std::string& expected) const {
    if (at_ >= text_.size()) refuse(fmt::format("the line ends where {} is expected; an object stands on one line", expected));
    const std::size_t length = std::max<std::size_t>(utf8Length(text_, at_), 1);
    refuse(fmt::format("{} is expected, not '{}'", expected, sim::shownName(text_.substr(at_, length))));
  }
  void skipSpace() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
  bool accept(char letter) {
    if (at_ >= text_.size() || text_[at_] != letter) return false;
    ++at_;
    return true;
  }
  bool acceptDigits() {
    const std::size_t start = at_;
    at_ = std::min(text_.find_first_not_of(NUMERALS, at_), text_.size());
    return at_ > start;
  }

  JsonValue value() {
    skipSpace();
    JsonValue read;
    const char first = at_ < text_.size() ? text_[at_] : '\0';
    if (first == '{' || first == '[') {
      if (++nested_ > MOST_NESTED) refuse(fmt::format("nested more than {} deep", MOST_NESTED));
      first == '{' ? object(&read) : list(&read);
      --nested_;
    } else if (first == '"') {
      read.kind = JsonValue::Kind::TEXT;
      read.text = string();
    } else {
      word(&read);
    }
    return read;
  }

  /** Goes on behind an item of a list or object. @return whether another one follows */
  bool anotherItem(char end) {
    skipSpace();
    if (accept(end)) return false;
    if (!accept(',')) refuseNext(fmt::format("',' or '{}'", end));
    skipSpace();
    if (at_ < text_.size() && text_[at_] == end) refuse(fmt::format("there is a comma before '{}'; take it out", end));
    return true;
  }

  void list(JsonValue* read) {
    read->kind = JsonValue::Kind::LIST;
    accept('[');
    skipSpace();
    if (accept(']')) return;
    do read->items.push_back(value());
    while (anotherItem(']'));
  }

  void object(JsonValue* read) {
    read->kind = JsonValue::Kind::OBJECT;
    accept('{');
    skipSpace();
    if (accept('}')) return;
    do {
      if (at_ >= text_.size() || text_[at_] != '"') refuseNext("a key in double quotes");
      const std::string key = string();
      const auto same = [&](const auto& member) { return member.first == key; };
      if (std::any_of(read->members.begin(), read->members.end(), same))
        refuse(fmt::format("the key '{}' is given twice; keep one", sim::shownName(key)));
      skipSpace();
      if (!accept(':')) refuseNext(fmt::format("':' behind the key '{}'", sim::shownName(key)));
      read->members.emplace_back(key, value());
    } while (anotherItem('}'));
  }

  std::string string() {
    std::string characters;
    accept('"');
    while (!accept('"')) {
      if (at_ >= text_.size()) refuse("the line ends inside a string; end it with '\"'");
      if (accept('\\')) {
        characters += escape();
        continue;
      }
      const std::size_t length = utf8Length(text_, at_);
      if (length == 0) refuse("a byte that is no UTF-8; save the file as UTF-8");
      if (static_cast<unsigned char>(text_[at_]) < 0x20) refuse("a control character in a string; write it as \\n, \\t or \\u00..");
      characters += text_.substr(at_, length);
      at_ += length;
    }
    return characters;
  }

  std::string escape() {
    if (accept('u')) return character();
    const std::size_t which = at_ < text_.size() ? ESCAPES.find(text_[at_]) : std::string::npos;
    if (which == std::string::npos) refuse("a backslash that escapes nothing; write \\\\ for a backslash");
    ++at_;
    return {ESCAPED[which]};
  }

  /** Behind \u: one unit of UTF-16, or two. */
  std::string character() {
    std::uint32_t unit = hexadecimal();
    if (isHighSurrogate(unit) && text_.compare(at_, 2, "\\u") == 0) {
      at_ += 2;
      const std::uint32_t low = hexadecimal();
      if (isLowSurrogate(low)) unit = 0x10000 + ((unit - 0xd800) << 10) + (low - 0xdc00);
    }
    if (isHighSurrogate(unit) || isLowSurrogate(unit)) refuse("half a character: \\ud800 to \\udfff come in pairs");
    if (unit == 0) refuse("\\u0000, which no name and no file has; take it out");
    return utf8(unit);
  }

  std::uint32_t hexadecimal() {
    const std::string digits = text_.substr(at_, 4);
    if (digits.size() < 4 || digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
      refuse("\\u needs four hexadecimal digits");
    at_ += 4;
    return static_cast<std::uint32_t>(std::stoul(digits, nullptr, 16));
  }

  /** A number, true, false or null. */
  void word(JsonValue* read) {
    const std::size_t start = at_, end = std::min(text_.find_first_of(WORD_ENDS, at_), text_.size());
    read->text = text_.substr(start, end - start);
    if (read->text == "true" || read->text == "false") {
      read->kind = JsonValue::Kind::TRUTH;
    } else if (read->text == "null") {
      read->kind = JsonValue::Kind::NOTHING;
    } else if (read->text.empty()) {
      refuseNext("a value");
    } else if (isNumber(end)) {
      read->kind = JsonValue::Kind::NUMBER;
    } else {
      at_ = start;
      refuse(fmt::format("'{}' is no JSON; strings stand in double quotes, numbers are as 0.5 or -1e3, words are true, false and null",
                         sim::shownName(read->text)));
    }
    at_ = end;
  }
  /** Whether what comes next is a number that ends there. */
  bool isNumber(std::size_t end) {
    accept('-');
    if (!accept('0') && !acceptDigits()) return false;
    if (accept('.') && !acceptDigits()) return false;
    if (accept('e') || accept('E')) {
      if (!accept('+')) accept('-');
      if (!acceptDigits()) return false;
    }
    return at_ == end;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int nested_ = 0;
};

}  // namespace

const char* kindInWords(JsonValue::Kind kind) {
  switch (kind) {
    case JsonValue::Kind::TRUTH:
      return "true or false";
    case JsonValue::Kind::NUMBER:
      return "a number";
    case JsonValue::Kind::TEXT:
      return "a string";
    case JsonValue::Kind::LIST:
      return "a list";
    case JsonValue::Kind::OBJECT:
      return "an object";
    case JsonValue::Kind::NOTHING:
      break;
  }
  return "null";
}

JsonValue parseJson(const std::string& text) { return JsonParser(text).document(); }

std::string jsonText(const JsonValue& value) {
  if (value.kind == JsonValue::Kind::TEXT) return quotedJson(value.text);
  if (value.kind != JsonValue::Kind::LIST && value.kind != JsonValue::Kind::OBJECT) return value.text;
  std::vector<std::string> parts;
  for (const JsonValue& item : value.items) parts.push_back(jsonText(item));
  for (const auto& [key, member] : value.members) parts.push_back(quotedJson(key) + ": " + jsonText(member));
  const bool list = value.kind == JsonValue::Kind::LIST;
  return fmt::format("{}{}{}", list ? '[' : '{', fmt::join(parts, ", "), list ? ']' : '}');
}

}  // namespace blem_sim
