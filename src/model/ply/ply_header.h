// The header of a PLY file.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace blem_sim::model {

enum class PlyType { INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64 };

constexpr std::size_t bytesOf(PlyType type) {
  constexpr std::size_t BYTES[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return BYTES[static_cast<int>(type)];
}

struct PlyProperty {
  std::string name;
  PlyType type;                       ///< of a value
  std::optional<PlyType> count_type;  ///< of the number of values of a list; none: one value

  /** Whether it lists the vertices of a face. */
  bool isCorners() const { return count_type && (name == "vertex_indices" || name == "vertex_index"); }
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;  ///< rows
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Format { ASCII, LITTLE, BIG };

  std::optional<Format> format;
  std::vector<PlyElement> elements;  ///< no name twice
  std::size_t data = 0;              ///< first byte of the rows

  /** Rows of an element, 0 if there is none. */
  std::size_t countOf(const std::string& element) const;
};

/** @param bytes of the file @throws InputError: a header that is none, vertices without x, y and z, faces without their vertices */
PlyHeader readPlyHeader(const std::string& file, const std::string& bytes);

}  // namespace blem_sim::model
