#include "blem_sim/model/voxel_map.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace blem_sim::model {
namespace {

constexpr int BITS = 21;  // of a coordinate in a key
constexpr double FARTHEST = (1 << (BITS - 1)) - 1;

/** Key of the cube that holds a point. False if it lies too far away. */
bool keyOf(const Vector3& p, double voxel, std::uint64_t* key) {
  *key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cube = std::floor(p[axis] / voxel);
    if (!(std::abs(cube) <= FARTHEST)) return false;
    *key = *key << BITS | static_cast<std::uint64_t>(static_cast<std::int64_t>(cube) + (1 << (BITS - 1)));
  }
  return true;
}

}  // namespace

/** Cubes of one cloud, with the means of its points in them, sorted by key. */
std::vector<VoxelMap::Cell> VoxelMap::cellsOf(const std::vector<Vector3>& points) const {
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  order.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint64_t key = 0;
    if (keyOf(points[i], options_.voxel, &key)) order.emplace_back(key, i);
  }
  std::sort(order.begin(), order.end());
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < order.size();) {
    Vector3 sum = Vector3::Zero();
    const std::size_t first = i;
    for (; i < order.size() && order[i].first == order[first].first; ++i) sum += points[order[i].second];
    cells.push_back({order[first].first, sum / static_cast<double>(i - first), 1, latest_});
  }
  return cells;
}

void VoxelMap::merge(const std::vector<Cell>& fresh) {
  std::vector<Cell> merged;
  merged.reserve(cells_.size() + fresh.size());
  auto old = cells_.begin();
  for (const Cell& cell : fresh) {
    for (; old != cells_.end() && old->key < cell.key; ++old) merged.push_back(*old);
    if (old == cells_.end() || old->key != cell.key) {
      merged.push_back(cell);
      continue;
    }
    Cell both = *old++;
    both.hits = std::min(both.hits, std::numeric_limits<int>::max() - 1) + 1;
    both.mean += (cell.mean - both.mean) / std::min(both.hits, options_.memory);
    both.last_hit = latest_;
    merged.push_back(both);
  }
  merged.insert(merged.end(), old, cells_.end());
  cells_ = std::move(merged);
}

void VoxelMap::forget() {
  const auto is_old = [this](const Cell& cell) { return latest_ - cell.last_hit > options_.expire_after; };
  cells_.erase(std::remove_if(cells_.begin(), cells_.end(), is_old), cells_.end());
  if (cells_.size() <= options_.max_voxels) return;
  // The newest stay, of equal ones those of the smaller keys.
  const auto newer = [](const Cell& a, const Cell& b) { return std::make_tuple(-a.last_hit, a.key) < std::make_tuple(-b.last_hit, b.key); };
  const auto end = cells_.begin() + static_cast<std::ptrdiff_t>(options_.max_voxels);
  std::nth_element(cells_.begin(), end, cells_.end(), newer);
  cells_.erase(end, cells_.end());
  std::sort(cells_.begin(), cells_.end(), [](const Cell& a, const Cell& b) { return a.key < b.key; });
}

void VoxelMap::add(const std::vector<Vector3>& points, double time) {
  latest_ = std::max(latest_, time);
  merge(cellsOf(points));
  forget();
}

std::vector<Vector3> VoxelMap::points() const {
  std::vector<Vector3> means;
  for (const Cell& cell : cells_)
    if (cell.hits >= options_.min_hits) means.push_back(cell.mean);
  return means;
}

}  // namespace blem_sim::model
