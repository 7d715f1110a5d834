// Thrown bodies must not pass any body, however thin, at any turn; and the largest time of a step.
#include <gtest/gtest.h>

#include <random>

#include "sim/contacts/fast_throw.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

/** Throws in every orientation at a speed; prints the outcome. */
void sweep(const std::string& name, sim::ThrowScene scene, double speed) {
  sim::ThrowOutcome all;
  StepTimes times;
  int passed = 0, pierced = 0, count = 0;
  for (const auto& turn : sim::THROWN_TURNS) {
    scene.turn = {turn[0], turn[1], turn[2]};
    scene.speed = speed;
    const sim::ThrowOutcome outcome = sim::throwIt(scene, soakSettings(), [&times](const auto& step) {
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
  EXPECT_LE(all.most_substeps, sim::Substeps::MAX_SUBSTEPS);
  EXPECT_LE(all.most_redone, sim::Substeps::MAX_REDONE);
}

/** Throws of any turn, spin, speed and place. */
TEST(FastThrows, AtRandom) {
  std::mt19937_64 generator(7);
  const auto uniform = [&generator](double low, double high) {
    return low + (high - low) * static_cast<double>(generator() >> 11) * 0x1p-53;
  };
  const auto vector = [&uniform](double size) {
    const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
    return Vector3(x, y, z);
  };
  const std::vector<sim::ThrowBody> thrown = {sim::cubeThrown(), sim::plateThrown()},
                                    hit = {sim::sheetHit(2, 1), sim::boxHit(), sim::plateHit(), sim::mugHit()};
  const int throws = soakShort() ? 200 : 2000;
  sim::ThrowOutcome all;
  StepTimes times;
  int passed = 0, pierced = 0;
  for (int i = 0; i < throws; ++i) {
    sim::ThrowScene scene{thrown[i % 2], hit[i / 2 % 4]};
    scene.turn = vector(M_PI);
    scene.spin = vector(60);
    scene.speed = uniform(3, 40);
    scene.beside = 0.04 * Vector3(uniform(-1, 1), uniform(-1, 1), 0);
    scene.both_move = i % 3 == 0 && i / 2 % 4 == 1;
    const sim::ThrowOutcome outcome = sim::throwIt(scene, soakSettings(), [&times](const auto& step) {
      times.start();
      step();
      times.stop();
    });
    passed += outcome.passed;
    pierced += outcome.pierced_steps > 0;
    all.join(outcome);
  }
  EXPECT_EQ(passed, 0);
  EXPECT_EQ(pierced, 0);
  EXPECT_LE(all.most_substeps, sim::Substeps::MAX_SUBSTEPS);
  EXPECT_LE(all.most_redone, sim::Substeps::MAX_REDONE);
  figure("throws at random: passed of " + std::to_string(throws), passed, "");
  figure("throws at random: pierced", pierced, "");
  figure("throws at random: worst step", 1e-3 * times.worst(), "ms");
  figure("throws at random: steps with redone solves", all.redone_steps, "");
  figure("throws at random: greatest depth", all.max_of_layer, "of the layer");
}

/** Mugs that start in each other part steadily. */
TEST(Recovery, InterlockedMugs) {
  sim::SimulationConfig config;
  config.solver = soakSettings();
  config.environments = {sim::ground()};
  for (int i = 0; i < 2; ++i) {
    sim::ObjectConfig mug;
    mug.name = "mug" + std::to_string(i);
    mug.uri = sim::mugThrown().uri;
    mug.mass = 0.3;
    mug.X_WO = i == 0 ? makePose({0, 0, 0.0026}) : makePose({0.05, 0.01, 0.0226}, {0.3, 0.2, 0.5});
    config.objects.push_back(mug);
  }
  sim::Simulator simulator(config, model::UriResolver());
  double fastest = 0, fastest_turn = 0, speed = 0;
  int unreliable = 0;
  for (int i = 0; i < 3000; ++i) {
    const sim::StepReport& report = simulator.step();
    ASSERT_FALSE(report.status & sim::STATE_NOT_FINITE);
    const bool crossed = report.status & sim::CONTACT_UNRELIABLE;
    unreliable += crossed;
    speed = 0;
    for (const dynamics::BodyState& body : report.bodies) {
      speed = std::max(speed, body.v_WCom.norm());
      if (!crossed) continue;
      fastest = std::max(fastest, body.v_WCom.norm());
      fastest_turn = std::max(fastest_turn, body.w_WB.norm());
    }
  }
  EXPECT_FALSE(simulator.report().status & sim::CONTACT_UNRELIABLE);
  EXPECT_LT(fastest, 0.5);
  EXPECT_LT(speed, 0.1);  // a mug may roll
  figure("interlocked mugs: steps until apart", unreliable, "");
  figure("interlocked mugs: fastest", fastest, "m/s");
  figure("interlocked mugs: fastest turn", fastest_turn, "rad/s");
  figure("interlocked mugs: speed after 3 s", speed, "m/s");
}

class FastDrops : public testing::TestWithParam<double> {};

TEST_P(FastDrops, CubeOnSheetOfTwoTriangles) { sweep("cube on sheet", {sim::cubeThrown(), sim::sheetHit(2, 1)}, GetParam()); }
TEST_P(FastDrops, CubeOnSheetOfMillimetreTriangles) {
  sweep("cube on fine sheet", {sim::cubeThrown(), sim::sheetHit(0.3, 300)}, GetParam());
}
TEST_P(FastDrops, CubeOnBox) { sweep("cube on box", {sim::cubeThrown(), sim::boxHit()}, GetParam()); }
TEST_P(FastDrops, CubeOnMug) { sweep("cube on mug", {sim::cubeThrown(), sim::mugHit()}, GetParam()); }
TEST_P(FastDrops, MugOnMug) { sweep("mug on mug", {sim::mugThrown(), sim::mugHit()}, GetParam()); }
TEST_P(FastDrops, PlateEdgeOnPlateEdge) { sweep("plate on plate", {sim::plateThrown(), sim::plateHit()}, GetParam()); }
TEST_P(FastDrops, TwoMovingCubes) {
  sim::ThrowScene scene{sim::cubeThrown(), sim::boxHit()};
  scene.both_move = true;
  sweep("cube against cube", scene, GetParam());
}
TEST_P(FastDrops, SpinningCubeOnSheet) {
  sim::ThrowScene scene{sim::cubeThrown(), sim::sheetHit(2, 1)};
  scene.spin = {60, 60, 53};
  sweep("cube at 100 rad/s on sheet", scene, GetParam());
}
TEST_P(FastDrops, SpinningPlateOnMug) {
  sim::ThrowScene scene{sim::plateThrown(), sim::mugHit()};
  scene.spin = {60, 60, 53};
  sweep("plate at 100 rad/s on mug", scene, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Speeds, FastDrops, testing::Values(10.0, 20.0, 40.0));

}  // namespace
}  // namespace blem_sim
