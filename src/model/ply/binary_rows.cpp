#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "ply/ply_rows.h"
#include "soup/soup_faces.h"

namespace blem_sim::model {
namespace {

template <typename T>
double valueAt(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

/** Reads values of one order of bytes; the machine's is little endian. */
class BinaryValues {
 public:
  BinaryValues(const std::string& bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}

  double at(std::size_t place, PlyType type) const {
    const char* bytes = bytes_.data() + place;
    char turned[8];
    if (swapped_) {
      std::reverse_copy(bytes, bytes + bytesOf(type), turned);
      bytes = turned;
    }
    switch (type) {
      case PlyType::INT8:
        return valueAt<std::int8_t>(bytes);
      case PlyType::UINT8:
        return valueAt<std::uint8_t>(bytes);
      case PlyType::INT16:
        return valueAt<std::int16_t>(bytes);
      case PlyType::UINT16:
        return valueAt<std::uint16_t>(bytes);
      case PlyType::INT32:
        return valueAt<std::int32_t>(bytes);
      case PlyType::UINT32:
        return valueAt<std::uint32_t>(bytes);
      case PlyType::FLOAT32:
        return valueAt<float>(bytes);
      case PlyType::FLOAT64:
        return valueAt<double>(bytes);
    }
    return 0;
  }

 private:
  const std::string& bytes_;
  bool swapped_;
};

/** The rows of a binary PLY. */
class BinaryRows {
 public:
  /** @throws InputError where the file ends before its rows */
  BinaryRows(const std::string& file, const std::string& bytes, const PlyHeader& header)
      : file(file), values(bytes, header.format == PlyHeader::Format::BIG), size_(bytes.size()) {
    std::size_t at = header.data;
    for (const PlyElement& element : header.elements) {
      places_[element.name] = {&element, at};
      at = walkFrom(at, element, [](std::size_t, const PlyProperty&, std::size_t, std::size_t) {});
    }
  }

  /** Calls visit(row, property, place of its first value, number of its values) for each row of an element, if it is there, and each of
   * its properties. */
  template <typename Visit>
  void walk(const std::string& element, Visit&& visit) const {
    if (const auto found = places_.find(element); found != places_.end()) walkFrom(found->second.second, *found->second.first, visit);
  }

  const std::string& file;
  const BinaryValues values;

 private:
  /** @param at first byte of the rows @return the first byte after them */
  template <typename Visit>
  std::size_t walkFrom(std::size_t at, const PlyElement& element, Visit&& visit) const {
    if (element.properties.empty()) return at;
    for (std::size_t row = 0; row < element.count; ++row) {
      for (const PlyProperty& property : element.properties) {
        std::size_t count = 1;
        if (property.count_type) {
          require(element, row, at, bytesOf(*property.count_type));
          count = countAt(element, row, at, *property.count_type);
          at += bytesOf(*property.count_type);
        }
        require(element, row, at, count * bytesOf(property.type));
        visit(row, property, at, count);
        at += count * bytesOf(property.type);
      }
    }
    return at;
  }

  std::size_t countAt(const PlyElement& element, std::size_t row, std::size_t at, PlyType type) const {
    const double count = values.at(at, type);
    if (count < 0)
      throw InputError(
          fmt::format("{}: PLY: row {} of element {} has a list of {:.0f} values; write the file anew", file, row, element.name, count));
    return static_cast<std::size_t>(count);
  }

  void require(const PlyElement& element, std::size_t row, std::size_t at, std::size_t bytes) const {
    if (bytes > size_ - at)
      throw InputError(fmt::format("{}: truncated PLY: {} rows of element {} announced, {} there; write the file anew", file, element.count,
                                   element.name, row));
  }

  std::size_t size_;
  std::map<std::string, std::pair<const PlyElement*, std::size_t>> places_;  // with the first byte of its rows
};

void readVertices(const BinaryRows& rows, std::size_t count, SurfaceSoup* soup) {
  std::vector<Vector3>& vertices = soup->mesh.vertices;
  vertices.resize(count);
  rows.walk("vertex", [&](std::size_t row, const PlyProperty& property, std::size_t place, std::size_t) {
    if (property.name.size() != 1 || property.count_type) return;
    const int axis = property.name[0] - 'x';
    if (axis >= 0 && axis < 3) vertices[row][axis] = rows.values.at(place, property.type);
  });
}

/** Reads the rows that name vertices. */
class CornerRows {
 public:
  CornerRows(const BinaryRows& rows, std::size_t vertices) : rows_(rows), vertices_(static_cast<double>(vertices)) {}

  /** Calls visit(corners) for each row of an element. @param lowest index that may be there: 0, or -1 as a separator */
  template <typename Visit>
  void walk(const std::string& element, int lowest, Visit&& visit) {
    rows_.walk(element, [&](std::size_t row, const PlyProperty& property, std::size_t place, std::size_t count) {
      if (!property.isCorners()) return;
      corners_.resize(count);
      for (std::size_t i = 0; i < count; ++i) {
        const double index = rows_.values.at(place + i * bytesOf(property.type), property.type);
        if (!(index >= lowest && index < vertices_))
          throw InputError(fmt::format("{}: {} {} names vertex {:.0f}, but there are only {:.0f}; write the file anew", rows_.file, element,
                                       row, index, vertices_));
        corners_[i] = static_cast<int>(index);
      }
      visit(corners_);
    });
  }

 private:
  const BinaryRows& rows_;
  double vertices_;
  std::vector<int> corners_;
};

/** Every corner of a strip but the first two ends a triangle, of alternate winding; -1 begins another strip. */
void appendStrips(const std::vector<int>& corners, SoupFaces* faces) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] < 0) first = i + 1;
    if (i < first + 2) continue;
    const bool turned = (i - first) % 2 == 1;
    faces->append({corners[turned ? i - 1 : i - 2], corners[turned ? i - 2 : i - 1], corners[i]});
  }
}

}  // namespace

SurfaceSoup readBinaryPly(const std::string& file, const std::string& bytes, const PlyHeader& header) {
  // All rows are there before memory is asked for; faces may come before their vertices.
  const BinaryRows rows(file, bytes, header);
  SurfaceSoup soup;
  readVertices(rows, header.countOf("vertex"), &soup);
  soup.mesh.elements.reserve(header.countOf("face"));
  SoupFaces faces(&soup);
  CornerRows corner_rows(rows, soup.mesh.vertices.size());
  corner_rows.walk("face", 0, [&](const std::vector<int>& corners) { faces.append(corners); });
  corner_rows.walk("tristrips", -1, [&](const std::vector<int>& corners) { appendStrips(corners, &faces); });
  faces.tell();
  soup.width = static_cast<int>(soup.mesh.vertices.size());
  return soup;
}

}  // namespace blem_sim::model
