#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "clouds/cloud_meshers.h"

namespace blem_sim::model {
namespace {

using Cell = std::array<std::int64_t, 3>;

/** Points by cells of a grid, and the parts that cells beside each other make. */
class OccupiedCells {
 public:
  OccupiedCells(const std::vector<Vector3>& points, double width) {
    for (const Vector3& p : points) cells_.push_back(&*part_of_.emplace(cellOf(p, width), NONE).first);
    for (auto& cell : part_of_)
      if (cell.second == NONE) spread(parts_++, &cell);
  }

  int parts() const { return parts_; }
  int partOf(std::size_t point) const { return cells_[point]->second; }

 private:
  static constexpr int NONE = -1;
  using Occupied = std::pair<const Cell, int>;

  static Cell cellOf(const Vector3& p, double width) {
    constexpr double FARTHEST = 1e15;  // [cells]
    Cell cell;
    for (int i = 0; i < 3; ++i) cell[i] = static_cast<std::int64_t>(std::floor(std::clamp(p[i] / width, -FARTHEST, FARTHEST)));
    return cell;
  }

  void spread(int part, Occupied* first) {
    first->second = part;
    std::vector<const Cell*> reached = {&first->first};
    while (!reached.empty()) {
      const Cell at = *reached.back();
      reached.pop_back();
      for (int i = 0; i < 27; ++i) {
        const auto beside = part_of_.find({at[0] + i % 3 - 1, at[1] + i / 3 % 3 - 1, at[2] + i / 9 - 1});
        if (beside == part_of_.end() || beside->second != NONE) continue;
        beside->second = part;
        reached.push_back(&beside->first);
      }
    }
  }

  std::map<Cell, int> part_of_;
  std::vector<const Occupied*> cells_;  // by point
  int parts_ = 0;
};

}  // namespace

std::vector<SeenPoints> partsApart(const SeenPoints& cloud, double distance) {
  const OccupiedCells cells(cloud.points, distance);
  std::vector<SeenPoints> parts(static_cast<std::size_t>(cells.parts()));
  for (SeenPoints& part : parts) part.viewpoint = cloud.viewpoint;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) parts[cells.partOf(i)].points.push_back(cloud.points[i]);
  return parts;
}

}  // namespace blem_sim::model
