#include "clouds/grid_message.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::node {
namespace {

void checkGrid(const nav_msgs::OccupancyGrid& grid) {
  const std::uint64_t cells = std::uint64_t{grid.info.width} * grid.info.height;
  if (!std::isfinite(grid.info.resolution) || !(grid.info.resolution > 0))
    throw InputError(fmt::format("info.resolution: {} m/cell must be above 0", grid.info.resolution));
  if (cells == 0 || cells != grid.data.size())
    throw InputError(fmt::format("info.width {} and height {}: data has {} cells", grid.info.width, grid.info.height, grid.data.size()));
  if (cells > MOST_CELLS)
    throw InputError(
        fmt::format("info.width and height: {} cells are more than the {} that are taken; send a coarser map", cells, MOST_CELLS));
}

Pose originOf(const nav_msgs::OccupancyGrid& grid) {
  const auto& p = grid.info.origin.position;
  const auto& q = grid.info.origin.orientation;
  const Quaternion turn(q.w, q.x, q.y, q.z);
  const Vector3 place(p.x, p.y, p.z);
  if (!place.allFinite() || !turn.coeffs().allFinite() || !(turn.norm() > 0))
    throw InputError("info.origin: is no pose; its orientation must be a quaternion, as w: 1 is");
  Pose pose = Pose::Identity();
  pose.linear() = turn.normalized().toRotationMatrix();
  pose.translation() = place;
  return pose;
}

/** Adds rectangles over a grid's corners. */
class WallBuilder {
 public:
  WallBuilder(const nav_msgs::OccupancyGrid& grid, const GridWalls& walls)
      : grid_(grid),
        walls_(walls),
        width_(static_cast<int>(grid.info.width)),
        height_(static_cast<int>(grid.info.height)),
        X_FG_(originOf(grid)) {}

  geometry::TriangleMesh build() {
    addTops();
    for (int y = 0; y <= height_; ++y) addSides(y, true);
    for (int x = 0; x <= width_; ++x) addSides(x, false);
    return std::move(mesh_);
  }

 private:
  using Corner = std::pair<int, int>;  // x, y

  bool isWall(int x, int y) const {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return false;
    return grid_.data[static_cast<std::size_t>(y) * width_ + x] >= walls_.occupied;
  }
  Vector3 at(const Corner& corner, bool top) const {
    const double cell = grid_.info.resolution;
    return X_FG_ * Vector3(cell * corner.first, cell * corner.second, top ? walls_.height : 0);
  }
  /** A rectangle, counter-clockwise from outside. */
  void add(const std::array<Vector3, 4>& corners) {
    if (mesh_.elements.size() + 2 > MOST_WALL_TRIANGLES)
      throw InputError(
          fmt::format("data: the walls have more than the {} triangles that are taken; send a coarser map", MOST_WALL_TRIANGLES));
    const int first = static_cast<int>(mesh_.vertices.size());
    mesh_.vertices.insert(mesh_.vertices.end(), corners.begin(), corners.end());
    mesh_.elements.emplace_back(first, first + 1, first + 2);
    mesh_.elements.emplace_back(first, first + 2, first + 3);
  }
  void addTop(const Corner& low, const Corner& high) {
    add({at(low, true), at({high.first, low.second}, true), at(high, true), at({low.first, high.second}, true)});
  }
  /** Begin and end of the walls in a row. */
  std::vector<Corner> runsOf(int y) const {
    std::vector<Corner> runs;
    for (int x = 0; x < width_; ++x) {
      if (!isWall(x, y)) continue;
      const int begin = x;
      while (isWall(x, y)) ++x;
      runs.emplace_back(begin, x);
    }
    return runs;
  }
  void addTops() {
    std::vector<Corner> runs;
    for (int y = 0, first = 0; y <= height_; ++y) {
      std::vector<Corner> next = y < height_ ? runsOf(y) : std::vector<Corner>();
      if (y > 0 && y < height_ && next == runs) continue;
      for (const auto& [begin, end] : runs) addTop({begin, first}, {end, y});
      runs = std::move(next);
      first = y;
    }
  }
  /** -1: a wall before the line alone, 1: behind it alone, 0: no side. @param line of corners, along x or else along y */
  int sideAt(int line, int place, bool along_x) const {
    const bool before = along_x ? isWall(place, line - 1) : isWall(line - 1, place);
    const bool behind = along_x ? isWall(place, line) : isWall(line, place);
    return static_cast<int>(behind) - static_cast<int>(before);
  }
  void addSides(int line, bool along_x) {
    const int length = along_x ? width_ : height_;
    for (int place = 0; place < length;) {
      const int side = sideAt(line, place, along_x), begin = place;
      while (place < length && sideAt(line, place, along_x) == side) ++place;
      if (side == 0) continue;
      Corner from = along_x ? Corner(begin, line) : Corner(line, begin), to = along_x ? Corner(place, line) : Corner(line, place);
      if ((side > 0) != along_x) std::swap(from, to);
      add({at(from, false), at(to, false), at(to, true), at(from, true)});
    }
  }

  const nav_msgs::OccupancyGrid& grid_;
  const GridWalls& walls_;
  int width_, height_;
  Pose X_FG_;
  geometry::TriangleMesh mesh_;
};

}  // namespace

geometry::TriangleMesh wallsOf(const nav_msgs::OccupancyGrid& grid, const GridWalls& walls) {
  checkGrid(grid);
  return WallBuilder(grid, walls).build();
}

}  // namespace blem_sim::node
