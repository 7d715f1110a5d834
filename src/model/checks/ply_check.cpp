#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"
#include "checks/file_check.h"

namespace blem_sim::model {
namespace {

struct Property {
  std::string name;
  std::size_t bytes = 0;        // of a value
  std::size_t count_bytes = 0;  // > 0: a list, whose count takes so many
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct PlyHeader {
  std::string format;  // ascii, binary_little_endian, binary_big_endian
  std::vector<PlyElement> elements;
  std::size_t data = 0;  // first byte of the rows
};

std::size_t typeBytes(const std::string& type) {
  static const std::map<std::string, std::size_t> BYTES = {
      {"char", 1}, {"uchar", 1}, {"int8", 1},  {"uint8", 1},  {"short", 2}, {"ushort", 2},  {"int16", 2},  {"uint16", 2},
      {"int", 4},  {"uint", 4},  {"int32", 4}, {"uint32", 4}, {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = BYTES.find(type);
  return found == BYTES.end() ? 0 : found->second;
}

/** "property TYPE NAME" or "property list COUNT_TYPE TYPE NAME"; false if it is neither. */
bool addProperty(std::istringstream* row, std::vector<PlyElement>* elements) {
  Property property;
  std::string type;
  *row >> type;
  if (type == "list") {
    *row >> type;
    if (type.find("float") != std::string::npos || type.find("double") != std::string::npos) return false;
    property.count_bytes = typeBytes(type);
    if (property.count_bytes == 0) return false;
    *row >> type;
  }
  property.bytes = typeBytes(type);
  if (elements->empty() || property.bytes == 0 || !(*row >> property.name)) return false;
  elements->back().properties.push_back(property);
  return true;
}

/** One row of the header; false if it is none that the format knows. assimp runs off its data where it meets another. */
bool addHeaderRow(const std::string& line, PlyHeader* header) {
  static const std::set<std::string> FORMATS = {"ascii", "binary_little_endian", "binary_big_endian"};
  std::istringstream row(line);
  std::string keyword;
  row >> keyword;
  if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) return true;
  if (keyword == "property") return addProperty(&row, &header->elements);
  if (keyword == "format") return static_cast<bool>(row >> header->format) && FORMATS.count(header->format) == 1;
  PlyElement element;
  if (keyword != "element" || !(row >> element.name >> element.count)) return false;
  header->elements.push_back(element);
  return true;
}

PlyHeader readPlyHeader(const std::string& file, const std::string& bytes) {
  std::string line;
  std::size_t at = 0;
  const auto next = [&] {
    if (at == bytes.size()) throw InputError(file + ": not a PLY file: its header has no 'end_header'; write the file anew");
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    line = bytes.substr(at, end - at);
    at = std::min(end + 1, bytes.size());
    if (!line.empty() && line.back() == '\r') line.pop_back();
  };
  next();
  if (line != "ply") throw InputError(file + ": not a PLY file: it does not begin with 'ply'; write the file anew");
  PlyHeader header;
  for (next(); line != "end_header"; next())
    if (!addHeaderRow(line, &header))
      throw InputError(fmt::format("{}: PLY header: '{}' is not understood; write the file anew", file, geometry::oneLine(line)));
  header.data = at;
  if (header.format.empty()) throw InputError(file + ": PLY header: no format; write the file anew");
  return header;
}

/** Vertices need x, y and z, faces the list of their vertices. */
void checkProperties(const std::string& file, const PlyHeader& header) {
  std::set<std::string> seen;
  for (const PlyElement& element : header.elements) {
    if (!seen.insert(element.name).second)
      throw InputError(fmt::format("{}: PLY header: element {} twice; write the file anew", file, element.name));
    const auto has = [&](const std::string& name, bool list) {
      return std::any_of(element.properties.begin(), element.properties.end(),
                         [&](const Property& p) { return p.name == name && (p.count_bytes > 0) == list; });
    };
    if (element.name == "vertex" && !(has("x", false) && has("y", false) && has("z", false)))
      throw InputError(file + ": PLY header: its vertices have no x, y and z; write the file anew");
    if (element.name == "face" && !(has("vertex_indices", true) || has("vertex_index", true)))
      throw InputError(file + ": PLY header: its faces have no list vertex_indices; write the file anew");
  }
}

/** Steps over the rows of a binary PLY. */
class BinaryWalk {
 public:
  BinaryWalk(const std::string& file, const std::string& bytes, const PlyHeader& header)
      : file_(file), bytes_(bytes), header_(header), at_(header.data) {}

  void run() {
    for (const PlyElement& element : header_.elements)
      for (std::size_t row = 0; row < element.count; ++row)
        for (const Property& property : element.properties) step(element, row, property);
  }

 private:
  void step(const PlyElement& element, std::size_t row, const Property& property) {
    std::size_t values = 1;
    if (property.count_bytes > 0) {
      require(element, row, property.count_bytes);
      values = unsignedAt(property.count_bytes);
      at_ += property.count_bytes;
    }
    require(element, row, values * property.bytes);
    at_ += values * property.bytes;
  }

  void require(const PlyElement& element, std::size_t row, std::size_t bytes) const {
    if (bytes > bytes_.size() - at_)
      throw InputError(fmt::format("{}: truncated PLY: {} rows of element {} announced, {} there; write the file anew", file_,
                                   element.count, element.name, row));
  }

  std::size_t unsignedAt(std::size_t bytes) const {
    std::size_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      const std::size_t place = header_.format == "binary_big_endian" ? bytes - 1 - i : i;
      value |= static_cast<std::size_t>(static_cast<unsigned char>(bytes_[at_ + i])) << (8 * place);
    }
    return value;
  }

  const std::string& file_;
  const std::string& bytes_;
  const PlyHeader& header_;
  std::size_t at_;
};

/** An ASCII PLY has one row per line, of at least as many numbers as it has properties; a list begins with its count. */
void checkAsciiRows(const std::string& file, const std::string& bytes, const PlyHeader& header) {
  std::istringstream stream(bytes.substr(header.data));
  std::string line, word;
  for (const PlyElement& element : header.elements) {
    for (std::size_t row = 0; row < element.count; ++row) {
      do {
        if (!std::getline(stream, line))
          throw InputError(fmt::format("{}: truncated PLY: {} rows of element {} announced, {} there; write the file anew", file,
                                       element.count, element.name, row));
      } while (line.find_first_not_of(" \t\r") == std::string::npos);
      std::istringstream words(line);
      bool complete = true;
      for (const Property& property : element.properties) {
        std::size_t values = 1;
        if (property.count_bytes > 0) complete = complete && words >> values;
        for (std::size_t i = 0; complete && i < values; ++i) complete = static_cast<bool>(words >> word);
      }
      if (!complete)
        throw InputError(fmt::format("{}: PLY: row {} of element {} is too short; write the file anew", file, row, element.name));
    }
  }
}

}  // namespace

PlyCounts checkPly(const std::string& file, const std::string& bytes) {
  const PlyHeader header = readPlyHeader(file, bytes);
  checkProperties(file, header);
  if (header.format == "ascii")
    checkAsciiRows(file, bytes, header);
  else
    BinaryWalk(file, bytes, header).run();
  PlyCounts counts;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") counts.vertices = element.count;
    if (element.name == "face") counts.faces = element.count;
  }
  if (counts.vertices == 0) throw InputError(file + ": the PLY holds no vertex; export the mesh again");
  return counts;
}

}  // namespace blem_sim::model
