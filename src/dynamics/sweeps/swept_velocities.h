// Velocities of an island while it is swept: those of free bodies in cache lines of their own, region by region, so that threads that sweep
// different regions never write to the same line.
#pragma once

#include <vector>

#include "problem/island_at_hand.h"
#include "sweeps/sweep_regions.h"
#include "trees/island_response.h"

namespace blem_sim::dynamics {

/** Numbers from `first` on, before `end`. */
struct NumberRange {
  int first, end;
};

class SweptVelocities {
 public:
  void arrange(const IslandAtHand& island, const IslandResponse& response, const SweepRegions& regions);
  /** Takes velocities by dof; those of an island with articulated trees stay where they are. */
  void take(Eigen::VectorXd* velocity);

  double* numbers() { return numbers_; }
  /** Length of numbers(). */
  int size() const { return size_; }
  /** Begin of the six numbers of a free body; -1: the static world. */
  int placeOf(const ResponseSide& body) const { return body.node < 0 ? -1 : lined_ ? LINE * rank_[body.base] : body.first_dof; }
  /** Velocities of a region's trees. The last region, the border, has trees only if there is no other one. */
  const NumberRange* begin(int region) const { return ranges_.data() + region_start_[region]; }
  const NumberRange* end(int region) const { return ranges_.data() + region_start_[region + 1]; }

 private:
  static constexpr int LINE = 8;
  struct alignas(sizeof(double) * LINE) Line {
    double numbers[LINE];
  };
  void arrangeLines(const IslandResponse& response, const SweepRegions& regions);
  void arrangeTrees(const IslandAtHand& island, const IslandResponse& response, const SweepRegions& regions);

  bool lined_ = false;
  int size_ = 0;
  double* numbers_ = nullptr;
  std::vector<Line> lines_;
  std::vector<int> rank_, first_dof_;  // line by free body; first dof by line
  std::vector<NumberRange> ranges_;
  std::vector<int> region_start_;
};

}  // namespace blem_sim::dynamics
