// A map of cubes from clouds that come one after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim::model {

/** Settings of a VoxelMap. */
struct VoxelMapOptions {
  double voxel = 0.005;                                           ///< [m] edge of a cube
  int min_hits = 1;                                               ///< clouds that must have hit a cube before its point counts
  int memory = 100;                                               ///< clouds that a cube's mean goes back, about
  double expire_after = std::numeric_limits<double>::infinity();  ///< [s] since a cube was hit last
  std::size_t max_voxels = 1000000;                               ///< most cubes that are kept
};

/**
 * Keeps, per cube that was hit, the mean of its points, the number of clouds that hit it and the time of the last one. The mean moves
 * towards that of a new cloud's points by one over the hits, `memory` at most, so noise is averaged and a surface that moves inside a cube
 * is still followed. Deterministic: the same clouds in the same order give the same bits.
 */
class VoxelMap {
 public:
  explicit VoxelMap(const VoxelMapOptions& options) : options_(options) {}

  /**
   * Adds a cloud, then forgets cubes that have expired at its time, and those hit longest ago beyond max_voxels.
   * @param points [m], finite; those beyond 2^20 cubes from the origin along an axis are left out @param time [s]; may go back: ages count
   * from the latest time
   */
  void add(const std::vector<Vector3>& points, double time);
  /** Means of the cubes with hits enough, in the order of the cubes. */
  std::vector<Vector3> points() const;
  std::size_t size() const { return cells_.size(); }
  void clear() { cells_.clear(); }

 private:
  struct Cell {
    std::uint64_t key;
    Vector3 mean;
    int hits;
    double last_hit;
  };

  std::vector<Cell> cellsOf(const std::vector<Vector3>& points) const;
  void merge(const std::vector<Cell>& fresh);
  void forget();

  VoxelMapOptions options_;
  double latest_ = -std::numeric_limits<double>::infinity();  // [s]
  std::vector<Cell> cells_;                                   // sorted by key
};

}  // namespace blem_sim::model
