#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <exception>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "blem_sim/geometry/for_all.h"
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

/** The rows of a binary PLY, in blocks that threads share. */
class BinaryRows {
 public:
  /** @throws InputError where the file ends before its rows */
  BinaryRows(const std::string& file, const std::string& bytes, const PlyHeader& header)
      : file(file), values(bytes, header.format == PlyHeader::Format::BIG), bytes_(bytes) {
    std::size_t at = header.data;
    for (const PlyElement& element : header.elements) {
      Rows& rows = rows_[element.name];
      rows.element = &element;
      at = findBlocks(at, &rows);
    }
  }

  /** Number of an element's blocks of rows, 0 if it is not there. */
  std::size_t blocks(const std::string& element) const {
    const auto found = rows_.find(element);
    return found == rows_.end() ? 0 : found->second.blocks.size();
  }

  /** Calls visit(row, property, place of its first value, number of its values) for each row of a block of an element, and each of its
   * properties. */
  template <typename Visit>
  void walk(const std::string& element, std::size_t block, Visit&& visit) const {
    const Rows& rows = rows_.at(element);
    walkBlock(*rows.element, rows.blocks[block], visit);
  }

  const std::string& file;
  const BinaryValues values;

 private:
  struct Block {
    std::size_t row, count;  ///< the first row, and how many
    std::size_t at;          ///< first byte
  };
  struct Rows {
    const PlyElement* element;
    std::vector<Block> blocks;
  };

  /** @param at first byte of the rows @return the first byte after them */
  std::size_t findBlocks(std::size_t at, Rows* rows) const {
    constexpr std::size_t ROWS = 1 << 14;
    const PlyElement& element = *rows->element;
    if (element.properties.empty() || element.count == 0) return at;
    const std::size_t length = commonLength(at, element);
    for (std::size_t row = 0; row < element.count; row += ROWS) {
      const Block block{row, std::min(ROWS, element.count - row), at};
      rows->blocks.push_back(block);
      at = length > 0 ? at + block.count * length : walkBlock(element, block, [](auto&&...) {});
    }
    return at;
  }

  /** Bytes of a row where all rows are there and their lists are as long as those of the first one; else 0. */
  std::size_t commonLength(std::size_t at, const PlyElement& element) const {
    std::vector<std::pair<std::size_t, std::size_t>> counts;  // of the lists: first byte in the row, bytes
    const auto addCount = [&](std::size_t, const PlyProperty& property, std::size_t place, std::size_t) {
      if (!property.count_type) return;
      const std::size_t bytes = bytesOf(*property.count_type);
      counts.emplace_back(place - bytes - at, bytes);
    };
    const std::size_t length = walkBlock(element, {0, 1, at}, addCount) - at;
    if (element.count > (bytes_.size() - at) / length) return 0;
    const char* const first = bytes_.data() + at;
    std::atomic<bool> common{true};
    geometry::forAll(element.count, [&](std::size_t row) {
      for (const auto& [place, bytes] : counts)
        if (std::memcmp(first + place, first + row * length + place, bytes) != 0) common.store(false, std::memory_order_relaxed);
    });
    return common ? length : 0;
  }

  /** @return the first byte after the block */
  template <typename Visit>
  std::size_t walkBlock(const PlyElement& element, const Block& block, Visit&& visit) const {
    std::size_t at = block.at;
    for (std::size_t row = block.row; row < block.row + block.count; ++row) {
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
    if (bytes > bytes_.size() - at)
      throw InputError(fmt::format("{}: truncated PLY: {} rows of element {} announced, {} there; write the file anew", file, element.count,
                                   element.name, row));
  }

  const std::string& bytes_;
  std::map<std::string, Rows> rows_;  // by element
};

void readVertices(const BinaryRows& rows, std::size_t count, SurfaceSoup* soup) {
  std::vector<Vector3>& vertices = soup->mesh.vertices;
  vertices.resize(count);
  const auto read = [&](std::size_t row, const PlyProperty& property, std::size_t place, std::size_t) {
    if (property.name.size() != 1 || property.count_type) return;
    const int axis = property.name[0] - 'x';
    if (axis >= 0 && axis < 3) vertices[row][axis] = rows.values.at(place, property.type);
  };
  tbb::parallel_for(std::size_t{0}, rows.blocks("vertex"), [&](std::size_t block) { rows.walk("vertex", block, read); });
}

/** Reads the rows that name vertices. */
class CornerRows {
 public:
  CornerRows(const BinaryRows& rows, std::size_t vertices) : rows_(rows), vertices_(static_cast<double>(vertices)) {}

  /** Calls visit(corners) for each row of a block of an element. @param lowest index that may be there: 0, or -1 as a separator */
  template <typename Visit>
  void walk(const std::string& element, std::size_t block, int lowest, Visit&& visit) const {
    std::vector<int> corners;
    rows_.walk(element, block, [&](std::size_t row, const PlyProperty& property, std::size_t place, std::size_t count) {
      if (!property.isCorners()) return;
      corners.resize(count);
      for (std::size_t i = 0; i < count; ++i) {
        const double index = rows_.values.at(place + i * bytesOf(property.type), property.type);
        if (!(index >= lowest && index < vertices_))
          throw InputError(fmt::format("{}: {} {} names vertex {:.0f}, but there are only {:.0f}; write the file anew", rows_.file, element,
                                       row, index, vertices_));
        corners[i] = static_cast<int>(index);
      }
      visit(corners);
    });
  }

 private:
  const BinaryRows& rows_;
  double vertices_;
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

/** Faces, then strips. Of rows that are wrong the first one is told, whichever thread comes across one first. */
void readFaces(const BinaryRows& rows, SurfaceSoup* soup) {
  const CornerRows corner_rows(rows, soup->mesh.vertices.size());
  const std::size_t face_blocks = rows.blocks("face");
  std::vector<SoupFaces> lists(face_blocks + rows.blocks("tristrips"), SoupFaces(&soup->mesh.vertices));
  std::vector<std::exception_ptr> refused(lists.size());
  tbb::parallel_for(std::size_t{0}, lists.size(), [&](std::size_t i) {
    SoupFaces& faces = lists[i];
    try {
      if (i < face_blocks)
        corner_rows.walk("face", i, 0, [&](const std::vector<int>& corners) { faces.append(corners); });
      else
        corner_rows.walk("tristrips", i - face_blocks, -1, [&](const std::vector<int>& corners) { appendStrips(corners, &faces); });
    } catch (...) {
      refused[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& reason : refused)
    if (reason) std::rethrow_exception(reason);
  SoupFaces::give(std::move(lists), soup);
}

}  // namespace

SurfaceSoup readBinaryPly(const std::string& file, const std::string& bytes, const PlyHeader& header) {
  // All rows are there before memory is asked for; faces may come before their vertices.
  const BinaryRows rows(file, bytes, header);
  SurfaceSoup soup;
  readVertices(rows, header.countOf("vertex"), &soup);
  readFaces(rows, &soup);
  soup.width = static_cast<int>(soup.mesh.vertices.size());
  return soup;
}

}  // namespace blem_sim::model
