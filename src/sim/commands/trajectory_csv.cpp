#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <locale>
#include <set>
#include <sstream>

#include "blem_sim/sim/trajectory.h"
#include "numbers/nearest_name.h"

namespace blem_sim::sim {

namespace {

const std::string BYTE_ORDER_MARK = "\xef\xbb\xbf";  // of UTF-8, with which spreadsheets begin a file
const std::string TIME = "time";
const std::string VELOCITY_SUFFIX = "_vel";

/** Places of a file's columns. */
struct Columns {
  std::size_t count = 0, time = 0;
  std::vector<std::string> joints;
  std::vector<std::size_t> positions, velocities;
};

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\"");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> row;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) row.push_back(trimmed(cell));
  if (!line.empty() && line.back() == ',') row.emplace_back();
  return row;
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/** The joint whose velocity a column holds; empty if it holds none. */
std::string velocityColumn(const std::string& column, const std::set<std::string>& joints) {
  if (joints.count(column) || !endsWith(column, VELOCITY_SUFFIX)) return "";
  const std::string joint = column.substr(0, column.size() - VELOCITY_SUFFIX.size());
  return joints.count(joint) ? joint : "";
}

void checkHeader(const std::string& file, const std::vector<std::string>& header) {
  std::set<std::string> seen;
  for (const std::string& name : header)
    if (!name.empty() && !seen.insert(name).second) throw InputError(fmt::format("{}: column '{}' is there twice; keep one", file, name));
  if (!seen.count(TIME))
    throw InputError(fmt::format("{}: there is no column 'time'; give the seconds from the start, one row per point (first column: '{}')",
                                 file, header.front()));
}

std::size_t columnOf(const std::string& name, const std::vector<std::string>& header) {
  return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
}

/** Velocities are for all joints or for none: a spline cannot be cubic for some. */
std::vector<std::size_t> velocityColumns(const std::string& file, const std::vector<std::string>& header,
                                         const std::vector<std::string>& joints, const std::set<std::string>& known) {
  const auto is_velocity = [&](const std::string& name) { return !velocityColumn(name, known).empty(); };
  const auto given = std::count_if(header.begin(), header.end(), is_velocity);
  std::vector<std::size_t> places;
  for (const std::string& joint : joints) {
    const std::string column = joint + VELOCITY_SUFFIX;
    const std::size_t place = columnOf(column, header);
    if (is_velocity(column) && place < header.size()) places.push_back(place);
  }
  if (given > 0 && (places.size() != joints.size() || given != static_cast<std::ptrdiff_t>(joints.size())))
    throw InputError(
        fmt::format("{}: {} columns of velocities for {} joints; give NAME_vel for each joint or for none", file, given, joints.size()));
  return places;
}

Columns readHeader(const std::string& file, const std::vector<std::string>& header, const std::vector<std::string>& known_joints,
                   std::vector<std::string>* ignored) {
  checkHeader(file, header);
  const std::set<std::string> known(known_joints.begin(), known_joints.end());
  Columns columns;
  columns.count = header.size();
  columns.time = columnOf(TIME, header);
  for (const std::string& name : header) {
    if (known.count(name)) {
      columns.joints.push_back(name);
      columns.positions.push_back(columnOf(name, header));
    } else if (name != TIME && velocityColumn(name, known).empty() && ignored) {
      ignored->push_back(name);
    }
  }
  if (columns.joints.empty())
    throw InputError(fmt::format("{}: no column is named for a joint of the robot; the known one nearest to '{}' is '{}'", file,
                                 header.back(), nearestName(header.back(), known_joints)));
  columns.velocities = velocityColumns(file, header, columns.joints, known);
  return columns;
}

double readNumber(const std::string& file, int line, const std::string& cell) {
  std::istringstream stream(cell);
  stream.imbue(std::locale::classic());
  double value = 0;
  if (!(stream >> value) || !stream.eof() || !std::isfinite(value))
    throw InputError(fmt::format("{}:{}: '{}' is not a finite number; correct it", file, line, cell));
  return value;
}

TrajectoryPoint readPoint(const std::string& file, int line, const std::vector<std::string>& row, const Columns& columns) {
  if (row.size() != columns.count)
    throw InputError(fmt::format("{}:{}: {} values for {} columns; each row needs one per column", file, line, row.size(), columns.count));
  TrajectoryPoint point;
  point.time_from_start = readNumber(file, line, row[columns.time]);
  for (const std::size_t column : columns.positions) point.positions.push_back(readNumber(file, line, row[column]));
  for (const std::size_t column : columns.velocities) point.velocities.push_back(readNumber(file, line, row[column]));
  return point;
}

}  // namespace

JointTrajectory loadTrajectoryCsv(const std::string& file, const std::vector<std::string>& known_joints,
                                  std::vector<std::string>* ignored) {
  std::ifstream stream(file);
  if (!stream) throw InputError(fmt::format("{}: cannot be read; check the path", file));
  JointTrajectory trajectory;
  Columns columns;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (number == 1 && line.compare(0, BYTE_ORDER_MARK.size(), BYTE_ORDER_MARK) == 0) line.erase(0, BYTE_ORDER_MARK.size());
    const std::string content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    if (columns.count == 0) {
      columns = readHeader(file, cells(line), known_joints, ignored);
      trajectory.joints = columns.joints;
    } else {
      trajectory.points.push_back(readPoint(file, number, cells(line), columns));
    }
  }
  if (trajectory.points.empty()) throw InputError(fmt::format("{}: holds no rows; give a header line and one row per point", file));
  if (trajectory.points.front().time_from_start < 0)
    throw InputError(fmt::format("{}: column 'time' begins at {} s; begin at 0 or later", file, trajectory.points.front().time_from_start));
  try {
    checkTrajectory(trajectory, known_joints);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
  return trajectory;
}

}  // namespace blem_sim::sim
