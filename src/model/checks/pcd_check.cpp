#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/geometry/one_line.h"
#include "checks/file_check.h"

namespace blem_sim::model {
namespace {

/** LZF, the compression of PCD, turns three bytes into at most 264. */
constexpr double MOST_COMPRESSED = 88;

const std::set<std::string> KEYWORDS = {"VERSION", "FIELDS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};

/** Rows of the header by keyword. */
struct PcdHeader {
  std::map<std::string, std::vector<std::string>> rows;
  std::size_t data = 0;  // first byte behind it
};

[[noreturn]] void refuseCloud(const std::string& file, const std::string& what) {
  throw InputError(fmt::format("{}: not a PCD file: {}; write the file anew", file, geometry::oneLine(what)));
}

/** PCL's reader runs off its data where a row is missing or unknown, so the header is held to the letter. */
PcdHeader readPcdHeader(const std::string& file, const std::string& bytes) {
  PcdHeader header;
  while (header.data < bytes.size() && header.rows.count("DATA") == 0) {
    const std::size_t end = std::min(bytes.find('\n', header.data), bytes.size());
    const std::string line = bytes.substr(header.data, end - header.data);
    std::istringstream row(line);
    header.data = std::min(end + 1, bytes.size());
    std::string keyword;
    row >> keyword;
    if (keyword.empty() && !line.empty()) refuseCloud(file, "a row of its header has spaces alone");
    if (keyword.empty() || keyword[0] == '#') continue;
    if (KEYWORDS.count(keyword) == 0) refuseCloud(file, "its header has an unknown row");
    std::vector<std::string>& words = header.rows[keyword];
    if (!words.empty()) refuseCloud(file, keyword + " is given twice");
    for (std::string word; row >> word;) words.push_back(word);
    if (words.empty()) refuseCloud(file, keyword + " is empty");
  }
  for (const char* keyword : {"FIELDS", "SIZE", "TYPE", "WIDTH", "HEIGHT", "POINTS", "DATA"})
    if (header.rows.count(keyword) == 0) refuseCloud(file, fmt::format("its header has no {}", keyword));
  return header;
}

/** PCL's reader goes on behind DATA until a row begins with no keyword, and sizes the cloud anew by those that do. */
void checkDataBegin(const std::string& file, const std::string& bytes, std::size_t data) {
  while (data < bytes.size()) {
    const std::size_t end = std::min(bytes.find('\n', data), bytes.size());
    std::istringstream row(bytes.substr(data, end - data));
    data = end + 1;
    std::string word;
    if (!(row >> word) || word[0] == '#') continue;
    const auto begins = [&word](const std::string& keyword) { return word.compare(0, keyword.size(), keyword) == 0; };
    if (begins("COLUMNS") || std::any_of(KEYWORDS.begin(), KEYWORDS.end(), begins))
      refuseCloud(file, "its data begin like a row of a header");
    return;
  }
}

std::size_t toNumber(const std::string& file, const std::string& keyword, const std::string& word) {
  // A count of at most eighteen digits fits.
  if (word.find_first_not_of("0123456789") != std::string::npos || word.size() > 18)
    refuseCloud(file, fmt::format("{} '{}' is no count", keyword, word));
  return static_cast<std::size_t>(std::stoull(word));
}

std::vector<std::size_t> numbersOf(const std::string& file, const PcdHeader& header, const std::string& keyword) {
  std::vector<std::size_t> result;
  for (const std::string& word : header.rows.at(keyword)) result.push_back(toNumber(file, keyword, word));
  return result;
}

void checkFields(const std::string& file, const PcdHeader& header) {
  const std::size_t fields = header.rows.at("FIELDS").size();
  for (const char* keyword : {"SIZE", "TYPE", "COUNT"})
    if (header.rows.count(keyword) == 1 && header.rows.at(keyword).size() != fields)
      refuseCloud(file, fmt::format("{} names {} fields, FIELDS {}", keyword, header.rows.at(keyword).size(), fields));
  for (const std::string& type : header.rows.at("TYPE"))
    if (type != "F" && type != "I" && type != "U") refuseCloud(file, fmt::format("TYPE '{}' is not F, I or U", type));
  for (std::size_t i = 0; i < fields; ++i) {
    const std::string &size = header.rows.at("SIZE")[i], &type = header.rows.at("TYPE")[i];
    const bool known = size == "4" || size == "8" || (type != "F" && (size == "1" || size == "2"));
    if (!known) refuseCloud(file, fmt::format("SIZE {} does not go with TYPE {}", size, type));
  }
  if (header.rows.count("VIEWPOINT") == 1 && header.rows.at("VIEWPOINT").size() != 7) refuseCloud(file, "VIEWPOINT has not 7 numbers");
}

}  // namespace

void checkPcd(const std::string& file, const std::string& bytes) {
  const PcdHeader header = readPcdHeader(file, bytes);
  checkFields(file, header);
  checkDataBegin(file, bytes, header.data);
  const std::vector<std::size_t> sizes = numbersOf(file, header, "SIZE");
  std::vector<std::size_t> counts(sizes.size(), 1);
  if (header.rows.count("COUNT") == 1) counts = numbersOf(file, header, "COUNT");
  double point_bytes = 0, values = 0;  // doubles, so that absurd counts do not wrap around
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (counts[i] == 0) refuseCloud(file, "a COUNT is zero");
    point_bytes += static_cast<double>(sizes[i]) * static_cast<double>(counts[i]);
    values += static_cast<double>(counts[i]);
  }
  const double points = static_cast<double>(numbersOf(file, header, "POINTS")[0]);
  const double pixels =
      static_cast<double>(numbersOf(file, header, "WIDTH")[0]) * static_cast<double>(numbersOf(file, header, "HEIGHT")[0]);
  if (points == 0) throw InputError(file + ": the PCD holds no point; record the cloud again");
  if (points != pixels) refuseCloud(file, fmt::format("POINTS is {:.0f}, WIDTH times HEIGHT {:.0f}", points, pixels));
  const std::string& data = header.rows.at("DATA")[0];
  double least = points * point_bytes;
  if (data == "ascii")
    least = points * 2 * values - 1;
  else if (data == "binary_compressed")
    least /= MOST_COMPRESSED;
  else if (data != "binary")
    refuseCloud(file, "DATA is not ascii, binary or binary_compressed");
  const double held = static_cast<double>(bytes.size() - header.data);
  if (least > held)
    throw InputError(fmt::format("{}: truncated PCD: {:.0f} points announced need at least {:.0f} bytes, {:.0f} there; write the file anew",
                                 file, points, least, held));
}

}  // namespace blem_sim::model
