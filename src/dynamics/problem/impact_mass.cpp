#include "problem/impact_mass.h"

#include <algorithm>

namespace blem_sim::dynamics {

void ImpactSpace::resize(const Forest& forest) {
  for (auto* v : {&velocity, &leap, &momentum, &before, &column, &no_gains}) v->setZero(forest.dofCount());
  factor.resize(forest);
  paths.resize(forest);
  twist.resize(forest.nodes().size());
}

int ImpactMass::unitOf(int tree) const {
  const auto at = std::lower_bound(model_->trees.begin(), model_->trees.end(), tree);
  return ties_.islandOf(static_cast<int>(at - model_->trees.begin()));
}

void ImpactMass::factor(const Forest& forest, const ForestMotion& motion, const IslandModel& model, ImpactSpace* space) {
  model_ = &model;
  ties_.reset(model.treeCount());
  const auto treeOf = [&](int dof) { return forest.nodes()[forest.nodeOfDof(dof)].tree; };
  const auto placeOf = [&](int dof) {
    return static_cast<int>(std::lower_bound(model.trees.begin(), model.trees.end(), treeOf(dof)) - model.trees.begin());
  };
  for (const MimicFold& m : model.mimics) ties_.join(placeOf(m.dof), placeOf(m.master));
  const int count = ties_.number();
  if (static_cast<int>(units_.size()) < count) units_.resize(count);
  for (Unit& unit : units_) {
    unit.trees.clear();
    unit.response.dofs.clear();
    unit.folded = false;
  }
  for (const MimicFold& m : model.mimics) units_[unitOf(treeOf(m.dof))].folded = true;
  for (const int tree : model.trees) {
    Unit& unit = units_[unitOf(tree)];
    unit.trees.push_back(tree);
    const ForestTree& t = forest.trees()[tree];
    if (unit.folded)
      for (int k = t.first_dof; k < t.dof_end; ++k) unit.response.dofs.push_back(k);
    else
      factorTree({forest, tree, motion.mass}, &space->factor);
  }
  for (Unit& unit : units_)
    if (unit.folded) unit.response.factor(forest, motion, space->no_gains, model.mimics);
}

void ImpactMass::solve(const Forest& forest, int tree, Eigen::VectorXd* x, ImpactSpace* space) {
  const Unit& unit = units_[unitOf(tree)];
  if (!unit.folded) return solveTree(forest, tree, space->factor, x, &space->paths);
  values_.clear();
  for (const int k : unit.response.dofs) values_.push_back((*x)[k]);
  unit.response.solve(values_.data(), 1);
  for (std::size_t i = 0; i < values_.size(); ++i) (*x)[unit.response.dofs[i]] = values_[i];
}

}  // namespace blem_sim::dynamics
