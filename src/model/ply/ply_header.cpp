#include "ply/ply_header.h"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"

namespace blem_sim::model {
namespace {

std::optional<PlyType> typeNamed(const std::string& name) {
  static const std::map<std::string, PlyType> TYPES = {
      {"char", PlyType::INT8},     {"int8", PlyType::INT8},       {"uchar", PlyType::UINT8},    {"uint8", PlyType::UINT8},
      {"short", PlyType::INT16},   {"int16", PlyType::INT16},     {"ushort", PlyType::UINT16},  {"uint16", PlyType::UINT16},
      {"int", PlyType::INT32},     {"int32", PlyType::INT32},     {"uint", PlyType::UINT32},    {"uint32", PlyType::UINT32},
      {"float", PlyType::FLOAT32}, {"float32", PlyType::FLOAT32}, {"double", PlyType::FLOAT64}, {"float64", PlyType::FLOAT64}};
  const auto found = TYPES.find(name);
  return found == TYPES.end() ? std::nullopt : std::optional<PlyType>(found->second);
}

/** "property TYPE NAME" or "property list COUNT_TYPE TYPE NAME"; false if it is neither. */
bool addProperty(std::istringstream* row, std::vector<PlyElement>* elements) {
  PlyProperty property;
  std::string type;
  *row >> type;
  if (type == "list") {
    *row >> type;
    property.count_type = typeNamed(type);
    if (!property.count_type || *property.count_type >= PlyType::FLOAT32) return false;
    *row >> type;
  }
  const std::optional<PlyType> known = typeNamed(type);
  if (elements->empty() || !known || !(*row >> property.name)) return false;
  property.type = *known;
  elements->back().properties.push_back(property);
  return true;
}

bool addFormat(std::istringstream* row, PlyHeader* header) {
  static const std::map<std::string, PlyHeader::Format> FORMATS = {{"ascii", PlyHeader::Format::ASCII},
                                                                   {"binary_little_endian", PlyHeader::Format::LITTLE},
                                                                   {"binary_big_endian", PlyHeader::Format::BIG}};
  std::string name;
  *row >> name;
  const auto found = FORMATS.find(name);
  if (found == FORMATS.end()) return false;
  header->format = found->second;
  return true;
}

/** One row of the header; false if it is none that the format knows. assimp runs off its data where it meets another. */
bool addHeaderRow(const std::string& line, PlyHeader* header) {
  std::istringstream row(line);
  std::string keyword;
  row >> keyword;
  if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) return true;
  if (keyword == "property") return addProperty(&row, &header->elements);
  if (keyword == "format") return addFormat(&row, header);
  PlyElement element;
  if (keyword != "element" || !(row >> element.name >> element.count)) return false;
  header->elements.push_back(element);
  return true;
}

/** Vertices need x, y and z, faces the list of their vertices. */
void checkProperties(const std::string& file, const PlyHeader& header) {
  std::set<std::string> seen;
  for (const PlyElement& element : header.elements) {
    if (!seen.insert(element.name).second)
      throw InputError(fmt::format("{}: PLY header: element {} twice; write the file anew", file, element.name));
    const std::vector<PlyProperty>& properties = element.properties;
    const auto hasValue = [&](const std::string& name) {
      return std::any_of(properties.begin(), properties.end(), [&](const PlyProperty& p) { return p.name == name && !p.count_type; });
    };
    if (element.name == "vertex" && !(hasValue("x") && hasValue("y") && hasValue("z")))
      throw InputError(file + ": PLY header: its vertices have no x, y and z; write the file anew");
    if (element.name == "face" && std::none_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.isCorners(); }))
      throw InputError(file + ": PLY header: its faces have no list vertex_indices; write the file anew");
  }
  if (header.countOf("vertex") == 0) throw InputError(file + ": the PLY holds no vertex; export the mesh again");
}

}  // namespace

std::size_t PlyHeader::countOf(const std::string& element) const {
  const auto found = std::find_if(elements.begin(), elements.end(), [&](const PlyElement& e) { return e.name == element; });
  return found == elements.end() ? 0 : found->count;
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
  if (!header.format) throw InputError(file + ": PLY header: no format; write the file anew");
  checkProperties(file, header);
  return header;
}

}  // namespace blem_sim::model
