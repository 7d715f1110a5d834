// Messages of other libraries and words of files, fit for a message of one line.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace blem_sim::geometry {

/** Control characters, line ends among them, become spaces. */
inline std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  return text;
}

}  // namespace blem_sim::geometry
