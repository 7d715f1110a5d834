// The blocks of a Hessian against the same matrix written out.
#include "newton/hessian_blocks.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "dynamics/standing_trees.h"
#include "island/island_motion.h"
#include "support/standard_values.h"

namespace blem_sim::dynamics {
namespace {

/** A free torso with two arms of two links and a hand of two fingers on one of them, and a free ball. */
struct ArmsAndBall {
  ArmsAndBall() : scene({0, 0, 0}, {}) {
    const int torso = body();
    const int left = link(link(torso)), right = link(link(torso));
    finger = link(left);
    link(left);
    ball = body();
    standTrees(scene, &forest, &motion, &space);
    model.trees = {0, 1};
    tips = {forest.nodeOfBody(finger), forest.nodeOfBody(right), forest.nodeOfBody(torso)};
    for (int k = 0; k < forest.dofCount(); ++k) dofs.push_back(k);
  }
  int body() {
    BodySpec spec;
    spec.name = "body";
    spec.inertial.mass = 1;
    spec.inertial.inertia = Vector3(0.01, 0.02, 0.03).asDiagonal();
    return scene.addBody(spec);
  }
  int link(int parent) {
    JointSpec joint;
    joint.name = "joint";
    joint.parent = parent;
    joint.child = body();
    joint.axis = Vector3(1, 0.1 * joint.child, 0.3).normalized();
    joint.X_PJ = makePose({0.1, 0.05 * joint.child, 0});
    scene.addJoint(joint, 0);
    return joint.child;
  }
  void tie(int a, int b) {
    PairContacts of_pair;
    of_pair.pair.a = a;
    of_pair.pair.b = b;
    model.pairs.push_back(of_pair);
  }
  Eigen::MatrixXd subspaceOf(int node) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(6, forest.dofCount());
    const int last = forest.nodes()[node].last_dof;
    for (int e = 0; e < forest.rowLength(last); ++e) out.col(forest.columns(last)[e]) = motion.subspace[forest.columns(last)[e]];
    return out;
  }
  /** The mass matrix, and what ties the pairs. */
  Eigen::MatrixXd written(const Matrix6& stiffness) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(forest.dofCount(), forest.dofCount());
    for (const int k : dofs)
      for (int e = 0; e < forest.rowLength(k); ++e)
        out(k, forest.columns(k)[e]) = out(forest.columns(k)[e], k) = motion.mass[forest.rowStart(k) + e];
    for (const PairContacts& p : model.pairs) {
      const Eigen::MatrixXd tied = subspaceOf(p.pair.a).transpose() * stiffness * subspaceOf(p.pair.b);
      out -= tied + tied.transpose();
    }
    return out;
  }

  Scene scene;
  Forest forest;
  ForestMotion motion;
  SolverSpace space;
  IslandModel model;
  IslandAnswer answer;
  Team team;
  int finger = 0, ball = 0;
  std::vector<int> tips, dofs;
};

void expectSolvesAsWritten(ArmsAndBall* scene, const Eigen::MatrixXd& moves) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Matrix6 stiffness = Matrix6::NullaryExpr([&] { return 1e-3 * uniform(generator); });
  Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(scene->forest.dofCount(), [&] { return uniform(generator); });
  const Eigen::MatrixXd reduced = moves.transpose() * scene->written(stiffness) * moves;
  const Eigen::VectorXd expected = moves * reduced.llt().solve(moves.transpose() * x);
  const IslandAtHand island{scene->forest, scene->motion, scene->model, &scene->answer, &scene->space, &scene->team};
  HessianBlocks blocks;
  blocks.lay(island, scene->dofs);
  blocks.setZero();
  for (const PairContacts& p : scene->model.pairs) blocks.tie(p.pair, stiffness);
  blocks.add(scene->motion.mass);
  ASSERT_TRUE(blocks.factor());
  blocks.solve(&x);
  EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm());
}

Eigen::MatrixXd allMove(const ArmsAndBall& scene) { return Eigen::MatrixXd::Identity(scene.forest.dofCount(), scene.forest.dofCount()); }

TEST(HessianBlocks, OfATree) {
  ArmsAndBall scene;
  expectSolvesAsWritten(&scene, allMove(scene));
}

TEST(HessianBlocks, OfABallBetweenLimbs) {
  ArmsAndBall scene;
  for (const int tip : scene.tips) scene.tie(scene.forest.nodeOfBody(scene.ball), tip);
  expectSolvesAsWritten(&scene, allMove(scene));
}

TEST(HessianBlocks, OfLimbsThatTouchEachOther) {
  ArmsAndBall scene;
  scene.tie(scene.tips[0], scene.tips[1]);
  scene.tie(scene.tips[2], scene.tips[0]);
  expectSolvesAsWritten(&scene, allMove(scene));
}

TEST(HessianBlocks, OfFingersThatMimicEachOther) {
  ArmsAndBall scene;
  const int dof = scene.forest.nodes()[scene.tips[0]].first_dof, master = scene.forest.nodes()[scene.tips[0] + 1].first_dof;
  scene.model.mimics.push_back({dof, master, -0.5});
  scene.tie(scene.forest.nodeOfBody(scene.ball), scene.tips[0]);
  Eigen::MatrixXd moves = allMove(scene);
  moves.row(dof) = -0.5 * moves.row(master);
  moves.col(dof).swap(moves.col(moves.cols() - 1));
  moves.conservativeResize(moves.rows(), moves.cols() - 1);
  expectSolvesAsWritten(&scene, moves);
}

}  // namespace
}  // namespace blem_sim::dynamics
