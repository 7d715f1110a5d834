#include "sweeps/swept_velocities.h"

#include <algorithm>

namespace blem_sim::dynamics {

void SweptVelocities::arrange(const IslandAtHand& island, const IslandResponse& response, const SweepRegions& regions) {
  lined_ = response.movers() == response.freeBodies();
  ranges_.clear();
  region_start_.assign(1, 0);
  if (lined_)
    arrangeLines(response, regions);
  else
    arrangeTrees(island, response, regions);
}

void SweptVelocities::arrangeLines(const IslandResponse& response, const SweepRegions& regions) {
  rank_.resize(response.freeBodies());
  first_dof_.clear();
  for (int r = 0; r <= regions.count(); ++r) {
    const int first = static_cast<int>(first_dof_.size());
    for (int body = 0; body < response.freeBodies(); ++body) {
      if (regions.ofMover(body) != r) continue;
      rank_[body] = static_cast<int>(first_dof_.size());
      first_dof_.push_back(response.firstDof(body));
    }
    ranges_.push_back({LINE * first, LINE * static_cast<int>(first_dof_.size())});
    region_start_.push_back(static_cast<int>(ranges_.size()));
  }
  lines_.resize(first_dof_.size());
  size_ = LINE * static_cast<int>(lines_.size());
}

void SweptVelocities::arrangeTrees(const IslandAtHand& island, const IslandResponse& response, const SweepRegions& regions) {
  const std::vector<int>& trees = island.model.trees;
  for (int r = 0; r <= regions.count(); ++r) {
    for (std::size_t i = 0; i < trees.size(); ++i)
      if (regions.ofMover(response.moverOfTree(i)) == r)
        ranges_.push_back({island.tree(trees[i]).first_dof, island.tree(trees[i]).dof_end});
    region_start_.push_back(static_cast<int>(ranges_.size()));
  }
  size_ = island.forest.dofCount();
}

void SweptVelocities::take(Eigen::VectorXd* velocity) {
  numbers_ = velocity->data();
  if (!lined_) return;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    std::copy_n(velocity->data() + first_dof_[i], 6, lines_[i].numbers);
    std::fill(lines_[i].numbers + 6, lines_[i].numbers + LINE, 0);
  }
  numbers_ = lines_.front().numbers;
}

}  // namespace blem_sim::dynamics
