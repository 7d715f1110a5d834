// Reads JSON [RFC 8259], strictly: what yaml-cpp would take beside it (trailing commas, keys given twice, other quotes) is refused.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace blem_sim {

struct JsonValue {
  enum class Kind { NOTHING, TRUTH, NUMBER, TEXT, LIST, OBJECT };
  Kind kind = Kind::NOTHING;
  std::string text;  ///< a string's characters; a number's, true, false and null as they are written
  std::vector<JsonValue> items;
  std::vector<std::pair<std::string, JsonValue>> members;
};

/** "a number", "an object", ... */
const char* kindInWords(JsonValue::Kind kind);

/** @throws InputError: letter (a byte, from 1), the fault and its cure */
JsonValue parseJson(const std::string& text);

/** The value on one line. It is YAML, too. */
std::string jsonText(const JsonValue& value);

}  // namespace blem_sim
