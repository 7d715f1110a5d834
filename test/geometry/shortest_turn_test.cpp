#include "blem_sim/geometry/shortest_turn.h"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/random_shapes.h"

namespace blem_sim::geometry {
namespace {

void expectTurns(const Vector3& from, const Vector3& to) {
  const Quaternion turn = shortestTurn(from, to);
  EXPECT_NEAR(turn.norm(), 1, 1e-15);
  EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 2e-12) << from.transpose() << " to " << to.transpose();
  // No turn about the direction itself.
  EXPECT_NEAR(turn.vec().dot(from.normalized()), 0, 1e-12);
}

TEST(ShortestTurn, BringsOneDirectionOntoTheOther) {
  RandomShapes random(3);
  for (int i = 0; i < 1000; ++i) expectTurns(random.point(2), random.point(0.3));
  expectTurns(Vector3::UnitX(), Vector3::UnitX());
}

TEST(ShortestTurn, OfNearlyOppositeDirections) {
  RandomShapes random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 from = random.point(1);
    expectTurns(from, -from + std::pow(10, -1 - 0.016 * i) * random.point(1));
  }
  expectTurns(Vector3::UnitZ(), -Vector3::UnitZ());
  expectTurns(Vector3(1, 2, -3), Vector3(-1, -2, 3));
}

}  // namespace
}  // namespace blem_sim::geometry
