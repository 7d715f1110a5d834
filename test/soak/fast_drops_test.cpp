// Thrown bodies must not pass, whatever they hit, how they are turned and how thin it is; and what a step of it costs at most.
#include <gtest/gtest.h>

#include "sim/fast_throw.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

/** Throws in every orientation at a speed; prints what became of it. */
void sweep(const std::string& name, ThrowScene scene, double speed) {
  ThrowOutcome all;
  StepTimes times;
  int passed = 0, pierced = 0, count = 0;
  for (const auto& turn : THROWN_TURNS) {
    scene.turn = {turn[0], turn[1], turn[2]};
    scene.speed = speed;
    const ThrowOutcome outcome = throwIt(scene, soakSettings(), [&times](const auto& step) {
      times.start();
      step();
      times.stop();
    });
    EXPECT_FALSE(outcome.passed) << name << " " << speed << " m/s, turn " << scene.turn.transpose();
    passed += outcome.passed;
    pierced += outcome.pierced_steps > 0;
    if (outcome.pierced_steps > 0)
      std::printf("%s %g m/s turn %g %g %g: pierced in %d steps\n", name.c_str(), speed, turn[0], turn[1], turn[2], outcome.pierced_steps);
    ++count;
    all.join(outcome);
  }
  const std::string title = name + " " + std::to_string(static_cast<int>(speed)) + " m/s";
  figure(title + ": passed of " + std::to_string(count), passed, "");
  figure(title + ": pierced", pierced, "");
  figure(title + ": worst step", 1e-3 * times.worst(), "ms");
  figure(title + ": most substeps", all.most_substeps, "");
  figure(title + ": most redone solves", all.most_redone, "");
  figure(title + ": steps with redone solves", all.redone_steps, "");
  figure(title + ": greatest depth", all.max_of_layer, "of the layer");
  EXPECT_LE(all.most_substeps, Substeps::MAX_SUBSTEPS);
  EXPECT_LE(all.most_redone, Substeps::MAX_REDONE);
}

class FastDrops : public testing::TestWithParam<double> {};

TEST_P(FastDrops, CubeOnSheetOfTwoTriangles) { sweep("cube on sheet", {cubeThrown(), sheetHit(2, 1)}, GetParam()); }
TEST_P(FastDrops, CubeOnSheetOfMillimetreTriangles) { sweep("cube on fine sheet", {cubeThrown(), sheetHit(0.3, 300)}, GetParam()); }
TEST_P(FastDrops, CubeOnBox) { sweep("cube on box", {cubeThrown(), boxHit()}, GetParam()); }
TEST_P(FastDrops, CubeOnMug) { sweep("cube on mug", {cubeThrown(), mugHit()}, GetParam()); }
TEST_P(FastDrops, MugOnMug) { sweep("mug on mug", {mugThrown(), mugHit()}, GetParam()); }
TEST_P(FastDrops, PlateEdgeOnPlateEdge) { sweep("plate on plate", {plateThrown(), plateHit()}, GetParam()); }
TEST_P(FastDrops, TwoMovingCubes) {
  ThrowScene scene{cubeThrown(), boxHit()};
  scene.both_move = true;
  sweep("cube against cube", scene, GetParam());
}
TEST_P(FastDrops, SpinningCubeOnSheet) {
  ThrowScene scene{cubeThrown(), sheetHit(2, 1)};
  scene.spin = {60, 60, 53};
  sweep("cube at 100 rad/s on sheet", scene, GetParam());
}
TEST_P(FastDrops, SpinningPlateOnMug) {
  ThrowScene scene{plateThrown(), mugHit()};
  scene.spin = {60, 60, 53};
  sweep("plate at 100 rad/s on mug", scene, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Speeds, FastDrops, testing::Values(10.0, 20.0, 40.0));

}  // namespace
}  // namespace blem_sim
