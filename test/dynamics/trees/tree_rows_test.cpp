// Packed matrices along trees against dense ones.
#include "trees/tree_rows.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace blem_sim::dynamics {
namespace {

/** A free body that carries chains, one of which forks, and a chain that the world holds; on them a random matrix. */
class TreeRows : public ::testing::Test {
 protected:
  TreeRows() : scene_(Vector3::Zero(), {}) {
    const int root = body();
    for (const int length : {1, 4, 7}) {
      const int end = chain(root, length);
      if (length == 4) chain(end, 2), chain(end, 3);
    }
    chain(WORLD_BODY, 5);
    forest_.build(scene_);
    rows_.assign(forest_.entryCount(), 0);
    dense_.setZero(forest_.dofCount(), forest_.dofCount());
    x_.resize(forest_.dofCount());
    for (int k = 0; k < forest_.dofCount(); ++k) {
      x_[k] = uniform();
      for (int e = 0; e < forest_.rowLength(k); ++e) {
        const int column = forest_.columns(k)[e];
        const double value = column == k ? 20 + uniform() : uniform();
        rows_[forest_.rowStart(k) + e] = dense_(k, column) = dense_(column, k) = value;
      }
    }
    paths_.resize(forest_);
  }

  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-52 - 1; }

  int body() {
    BodySpec spec;
    spec.name = "body";
    spec.inertial.mass = 1;
    spec.inertial.inertia = Matrix3::Identity();
    return scene_.addBody(spec);
  }
  int chain(int parent, int length) {
    for (int i = 0; i < length; ++i) {
      JointSpec spec;
      spec.name = "joint";
      spec.kind = JointKind::REVOLUTE;
      spec.parent = parent;
      spec.child = parent = body();
      scene_.addJoint(spec, 0);
    }
    return parent;
  }

  int trees() const { return static_cast<int>(forest_.trees().size()); }

  std::mt19937_64 generator_{3};
  Scene scene_;
  Forest forest_;
  std::vector<double> rows_;
  Eigen::MatrixXd dense_;
  Eigen::VectorXd x_;
  TreePaths paths_;
};

TEST_F(TreeRows, Multiply) {
  ASSERT_EQ(trees(), 2);
  Eigen::VectorXd out = Eigen::VectorXd::Constant(x_.size(), 99);
  for (int tree = 0; tree < trees(); ++tree) multiply({forest_, tree, rows_}, x_, &out, &paths_);
  EXPECT_LT((out - dense_ * x_).norm(), 1e-12);
}

TEST_F(TreeRows, FactorSolves) {
  TreeFactor factor;
  factor.resize(forest_);
  factor.rows = rows_;
  for (int k = forest_.dofCount() - 1; k >= 0; --k) ASSERT_TRUE(eliminate(forest_, k, &factor));
  Eigen::VectorXd x = x_;
  for (int tree = 0; tree < trees(); ++tree) {
    reduce(forest_, tree, factor, &x, &paths_);
    substitute(forest_, tree, factor, &x, &paths_);
  }
  EXPECT_LT((dense_ * x - x_).norm(), 1e-12);
}

// Leaves first, and the rest of the matrix solved densely: two chains are eliminated, whose ancestors are not.
TEST_F(TreeRows, WhatSomeDofsLeaveToTheOthers) {
  TreeFactor factor;
  factor.resize(forest_);
  factor.rows = rows_;
  std::vector<int> left;
  for (int k = forest_.dofCount() - 1; k >= 0; --k) {
    if (forest_.rowLength(k) > 9)
      ASSERT_TRUE(eliminate(forest_, k, &factor));
    else
      left.push_back(k);
  }
  ASSERT_GT(left.size(), 9u);
  Eigen::VectorXd x = x_;
  for (int tree = 0; tree < trees(); ++tree) reduce(forest_, tree, factor, &x, &paths_);
  const int count = static_cast<int>(left.size());
  Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd right(count);
  for (int r = 0; r < count; ++r) {
    right[r] = x[left[r]];
    for (int e = 0; e < forest_.rowLength(left[r]); ++e)
      for (int c = 0; c < count; ++c)
        if (left[c] == forest_.columns(left[r])[e]) rest(r, c) = rest(c, r) = factor.rows[forest_.rowStart(left[r]) + e];
  }
  const Eigen::VectorXd solved = rest.llt().solve(right);
  for (int r = 0; r < count; ++r) x[left[r]] = solved[r];
  for (int tree = 0; tree < trees(); ++tree) substitute(forest_, tree, factor, &x, &paths_);
  EXPECT_LT((dense_ * x - x_).norm(), 1e-12);
}

TEST_F(TreeRows, RefusesWhatIsNotPositive) {
  TreeFactor factor;
  factor.resize(forest_);
  factor.rows = rows_;
  factor.rows[forest_.diagonal(forest_.dofCount() - 1)] = -1;
  EXPECT_FALSE(eliminate(forest_, forest_.dofCount() - 1, &factor));
}

}  // namespace
}  // namespace blem_sim::dynamics
