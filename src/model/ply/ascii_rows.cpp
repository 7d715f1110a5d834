#include <sstream>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "ply/ply_rows.h"

namespace blem_sim::model {
namespace {

/** Whether a row has as many numbers as its element has properties; a list begins with its count. */
bool isComplete(const std::string& line, const PlyElement& element) {
  std::istringstream words(line);
  std::string word;
  for (const PlyProperty& property : element.properties) {
    std::size_t values = 1;
    if (property.count_type && !(words >> values)) return false;
    for (std::size_t i = 0; i < values; ++i)
      if (!(words >> word)) return false;
  }
  return true;
}

}  // namespace

void checkAsciiPly(const std::string& file, const std::string& bytes, const PlyHeader& header) {
  std::istringstream stream(bytes.substr(header.data));
  std::string line;
  for (const PlyElement& element : header.elements) {
    for (std::size_t row = 0; row < element.count; ++row) {
      do {
        if (!std::getline(stream, line))
          throw InputError(fmt::format("{}: truncated PLY: {} rows of element {} announced, {} there; write the file anew", file,
                                       element.count, element.name, row));
      } while (line.find_first_not_of(" \t\r") == std::string::npos);
      if (!isComplete(line, element))
        throw InputError(fmt::format("{}: PLY: row {} of element {} is too short; write the file anew", file, row, element.name));
    }
  }
}

}  // namespace blem_sim::model
