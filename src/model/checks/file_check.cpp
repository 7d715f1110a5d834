#include "checks/file_check.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::model {
namespace {

constexpr std::size_t STL_HEADER = 84;    // 80 bytes of text, a 32-bit count
constexpr std::size_t STL_TRIANGLE = 50;  // 12 floats, a 16-bit attribute

std::size_t countWord(const std::string& bytes, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = bytes.find(word); at != std::string::npos; at = bytes.find(word, at + word.size())) {
    const bool starts = at == 0 || std::isspace(static_cast<unsigned char>(bytes[at - 1]));
    const std::size_t end = at + word.size();
    const bool ends = end == bytes.size() || std::isspace(static_cast<unsigned char>(bytes[end]));
    if (starts && ends) ++count;
  }
  return count;
}

/** "solid" alone does not tell: many binary headers start with it too. */
bool isAsciiStl(const std::string& bytes) {
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  if (start == std::string::npos || bytes.compare(start, 5, "solid") != 0) return false;
  if (bytes.size() >= STL_HEADER) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof(count));
    if (bytes.size() == STL_HEADER + STL_TRIANGLE * std::size_t{count}) return false;
  }
  return bytes.find('\0') == std::string::npos;
}

void checkAsciiStl(const std::string& file, const std::string& bytes) {
  const std::size_t open = countWord(bytes, "facet"), close = countWord(bytes, "endfacet"), vertices = countWord(bytes, "vertex");
  if (open != close || vertices != 3 * close)
    throw InputError(fmt::format("{}: truncated or damaged ASCII STL: {} facets begin, {} end, with {} vertices; write the file anew", file,
                                 open, close, vertices));
  if (close == 0) throw InputError(file + ": the STL holds no triangle; export the mesh again");
}

/** Reads the rows of a text format: comments and blank lines are left out. */
class TextRows {
 public:
  explicit TextRows(const std::string& bytes) : stream_(bytes) {}
  bool next(std::istringstream* row) {
    for (std::string line; std::getline(stream_, line);) {
      line.erase(std::min(line.find('#'), line.size()));
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      row->clear();
      row->str(line);
      return true;
    }
    return false;
  }

 private:
  std::istringstream stream_;
};

struct OffHeader {
  std::string keyword;
  long vertices = 0;
  long faces = 0;
};

/** Colours, normals and such before "OFF" add columns; "nOFF" has dimensions of its own. */
bool isOffKeyword(const std::string& keyword) {
  std::size_t at = 0;
  for (const std::string columns : {"ST", "C", "N", "4"})
    if (keyword.compare(at, columns.size(), columns) == 0) at += columns.size();
  return keyword.compare(at, std::string::npos, "OFF") == 0;
}

/** The counts stand behind the keyword or on the next row, all on one. */
bool readOffHeader(TextRows* rows, OffHeader* header) {
  std::istringstream row;
  if (!rows->next(&row) || !(row >> header->keyword) || !isOffKeyword(header->keyword)) return false;
  if ((row >> std::ws).eof() && !rows->next(&row)) return false;
  return row >> header->vertices >> header->faces && header->vertices >= 0 && header->faces >= 0;
}

void checkOffVertex(const std::string& file, std::istringstream* row, long vertex) {
  double x = 0, y = 0, z = 0;
  if (!(*row >> x >> y >> z)) throw InputError(fmt::format("{}: vertex {} has not three numbers; write the file anew", file, vertex));
}

void checkOffFace(const std::string& file, std::istringstream* row, long face, long vertices) {
  long corners = 0;
  if (!(*row >> corners) || corners < 1) throw InputError(fmt::format("{}: face {} has no corner count; write the file anew", file, face));
  for (long corner = 0; corner < corners; ++corner) {
    long index = -1;
    if (!(*row >> index))
      throw InputError(fmt::format("{}: face {} names fewer than its {} corners; write the file anew", file, face, corners));
    if (index < 0 || index >= vertices)
      throw InputError(fmt::format("{}: face {} names vertex {}, but there are only {} (0 to {}); write the file anew", file, face, index,
                                   vertices, vertices - 1));
  }
}

}  // namespace

std::string readBytes(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) throw InputError(file + ": no such file; check the path");
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(std::filesystem::file_size(file, error), '\0');
  if (error || !stream.read(&bytes[0], static_cast<std::streamsize>(bytes.size())))
    throw InputError(file + ": cannot be read; check its permissions");
  if (bytes.empty()) throw InputError(file + ": the file is empty; write it anew");
  return bytes;
}

void checkStl(const std::string& file, std::string* bytes, std::vector<std::string>* notes) {
  if (isAsciiStl(*bytes)) return checkAsciiStl(file, *bytes);
  if (bytes->size() < STL_HEADER)
    throw InputError(fmt::format("{}: truncated STL: {} bytes are less than a header; write the file anew", file, bytes->size()));
  std::uint32_t count = 0;
  std::memcpy(&count, bytes->data() + 80, sizeof(count));
  const std::size_t announced = STL_HEADER + STL_TRIANGLE * std::size_t{count};
  const std::size_t held = (bytes->size() - STL_HEADER) / STL_TRIANGLE;
  if (announced > bytes->size())
    throw InputError(fmt::format("{}: truncated STL: {} triangles announced, {} there; write the file anew", file, count, held));
  if (count == 0) throw InputError(file + ": the STL holds no triangle; export the mesh again");
  if (announced < bytes->size()) {
    notes->push_back(fmt::format("{} bytes after the announced {} triangles left out", bytes->size() - announced, count));
    bytes->resize(announced);
  }
}

void checkOff(const std::string& file, std::string* bytes) {
  TextRows rows(*bytes);
  OffHeader header;
  if (!readOffHeader(&rows, &header))
    throw InputError(file + ": not an OFF file: no 'OFF' with the counts of vertices and faces; write the file anew");
  const auto [keyword, vertices, faces] = header;
  if (vertices == 0) throw InputError(file + ": the OFF holds no vertex; export the mesh again");
  std::string checked = fmt::format("{}\n{} {} 0\n", keyword, vertices, faces);
  std::istringstream row;
  for (long vertex = 0; vertex < vertices; ++vertex) {
    if (!rows.next(&row))
      throw InputError(fmt::format("{}: truncated OFF: {} vertices announced, {} there; write the file anew", file, vertices, vertex));
    checkOffVertex(file, &row, vertex);
    checked += row.str() + '\n';
  }
  for (long face = 0; face < faces; ++face) {
    if (!rows.next(&row))
      throw InputError(fmt::format("{}: truncated OFF: {} faces announced, {} there; write the file anew", file, faces, face));
    checkOffFace(file, &row, face, vertices);
    checked += row.str() + '\n';
  }
  *bytes = checked;
}

}  // namespace blem_sim::model
