// Writes JSON [RFC 8259]; NaN and infinity, which are no numbers there, become null.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim {

/** The text as a JSON string. Bytes that are no UTF-8, as messages quote them from files, become U+FFFD. */
std::string quotedJson(const std::string& text);

/** Text, number or list on its way into a document. Objects are opened and closed by hand. */
class JsonWriter {
 public:
  enum class Layout { INDENTED, ONE_LINE };
  explicit JsonWriter(std::ostream& stream, Layout layout = Layout::INDENTED) : stream_(stream), layout_(layout) {}

  void openObject();
  void closeObject();
  void openList();
  void closeList();
  /** Name of the next value of an object. */
  JsonWriter& key(const std::string& name);
  void value(double number);
  void value(std::uint64_t number);
  void value(int number) { value(static_cast<double>(number)); }
  void value(const std::string& text);
  void boolean(bool truth);
  void value(const Vector3& vector);
  void value(const Quaternion& quaternion);  ///< [x, y, z, w]
  void value(const std::vector<double>& numbers);
  void value(const std::vector<std::string>& texts);

 private:
  void separate();
  void open(char bracket);
  void close(char bracket);
  bool onLinesOfItsOwn() const;
  void newLine();
  template <typename Values>
  void list(const Values& values);

  std::ostream& stream_;
  Layout layout_;
  std::vector<bool> empty_;  ///< per open bracket: nothing in it yet
  bool after_key_ = false;
};

}  // namespace blem_sim
