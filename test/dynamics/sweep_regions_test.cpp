// Regions of an island that threads sweep at once.
#include "sweeps/sweep_regions.h"

#include <gtest/gtest.h>

#include <vector>

#include "dynamics/analytic_contacts.h"
#include "dynamics/standing_trees.h"

namespace blem_sim::dynamics {
namespace {

constexpr double SIDE = 0.1;  // [m] of a cube

/** Cubes in columns (along x) and rows (along z), each against its neighbours; the lowest stand on the static world. */
struct Wall {
  Wall(int columns, int rows) : scene(Vector3::Zero(), {}) {
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column)
        scene.addBody(boxBody("cube", 1, Vector3::Constant(SIDE), {SIDE * column, 0, SIDE * row}));
    standTrees(scene, &forest, &motion, &space);
    for (int tree = 0; tree < columns * rows; ++tree) model.trees.push_back(tree);
    response.start(forest, motion, model.trees, model.mimics);
    response.factor(Eigen::VectorXd::Zero(forest.dofCount()));
    for (int i = 0; i < columns * rows; ++i) {
      if (i < columns) touch(i, -1);
      if (i % columns > 0) touch(i, i - 1);
      if (i >= columns) touch(i, i - columns);
    }
    regions.find({forest, motion, model, &answer, &space, &team}, response, pairs);
  }
  void touch(int a, int b) {
    BodyPair pair;
    pair.a = forest.nodeOfBody(a);
    pair.b = b < 0 ? -1 : forest.nodeOfBody(b);
    pairs.push_back(response.pair(pair));
  }
  int pairsOf(int region) const {
    int count = 0;
    for (const ResponsePair& pair : pairs) count += regions.ofPair(response, pair) == region;
    return count;
  }

  Scene scene;
  Forest forest;
  ForestMotion motion;
  SolverSpace space;
  IslandModel model;
  IslandAnswer answer;
  Team team;
  IslandResponse response;
  std::vector<ResponsePair> pairs;
  SweepRegions regions;
};

TEST(SweepRegions, ASmallIslandHasNone) {
  const Wall wall(10, 10);
  EXPECT_EQ(wall.regions.count(), 0);
  EXPECT_EQ(wall.pairsOf(0), 200 - 10);
}

TEST(SweepRegions, AreCutAcrossTheLongestSide) {
  for (const bool wide : {false, true}) {
    const Wall wall(wide ? 50 : 10, wide ? 10 : 50);
    ASSERT_EQ(wall.regions.count(), 2);
    EXPECT_NEAR(wall.pairsOf(2), 10, 1) << "cubes on both sides of the cut, which may have a stair";
    EXPECT_NEAR(wall.pairsOf(0), wall.pairsOf(1), 20);
    EXPECT_EQ(wall.pairsOf(0) + wall.pairsOf(1) + wall.pairsOf(2), static_cast<int>(wall.pairs.size()));
  }
}

TEST(SweepRegions, NoBodyIsInTwo) {
  const Wall wall(40, 20);
  for (const ResponsePair& pair : wall.pairs) {
    const int region = wall.regions.ofPair(wall.response, pair), of_a = wall.regions.ofMover(wall.response.moverOf(pair.a));
    const int of_b = pair.pair.b < 0 ? of_a : wall.regions.ofMover(wall.response.moverOf(pair.b));
    EXPECT_EQ(region, of_a == of_b ? of_a : wall.regions.count());
  }
}

TEST(SweepRegions, AreFourInAHugeIsland) {
  const Wall wall(70, 70);
  ASSERT_EQ(wall.regions.count(), 4);
  for (int region = 0; region < 4; ++region) EXPECT_NEAR(wall.pairsOf(region), wall.pairs.size() / 4.0, 0.05 * wall.pairs.size());
  EXPECT_LT(wall.pairsOf(4), 200);
}

// Half of the pairs would have to wait for both regions.
TEST(SweepRegions, AnIslandWhoseBodiesAllTouchStaysWhole) {
  Wall wall(8, 5);
  wall.pairs.clear();
  for (int a = 0; a < 40; ++a)
    for (int b = 0; b < a; ++b) wall.touch(a, b);
  wall.regions.find({wall.forest, wall.motion, wall.model, &wall.answer, &wall.space, &wall.team}, wall.response, wall.pairs);
  EXPECT_EQ(wall.regions.count(), 0);
  for (const ResponsePair& pair : wall.pairs) EXPECT_EQ(wall.regions.ofPair(wall.response, pair), 0);
}

}  // namespace
}  // namespace blem_sim::dynamics
