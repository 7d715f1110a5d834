// Fast drops: no body passes any other. A part of the sweep in test/soak/fast_drops_test.cpp.
#include "sim/contacts/fast_throw.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

struct Drop {
  const char* name;
  ThrowBody (*thrown)();
  ThrowBody (*hit)();
  bool both_move = false;
  Vector3 spin = Vector3::Zero();
  double at_rest = 0;
};

ThrowBody thinSheet() { return sheetHit(2, 1); }
ThrowBody fineSheet() { return sheetHit(0.3, 60); }
ThrowBody coarseMug() { return {meshFile("pipe", geometry::cylinderMesh(0.04, 0.1, 12)), 0.05, 0}; }

std::vector<Drop> drops() {
  return {{"cube on sheet", cubeThrown, thinSheet},
          {"cube on fine sheet", cubeThrown, fineSheet},
          {"cube on box", cubeThrown, boxHit},
          {"cube on cylinder", cubeThrown, coarseMug},
          {"plate's edge on plate's edge", plateThrown, plateHit},
          {"cube against cube", cubeThrown, boxHit, true},
          {"spinning cube on sheet", cubeThrown, thinSheet, false, {60, 60, 53}},
          {"spinning plate on plate", plateThrown, plateHit, false, {60, 60, 53}},
          {"cube on box at rest", cubeThrown, boxHit, false, Vector3::Zero(), 0.1},
          {"plate's edge on plate's edge at rest", plateThrown, plateHit, false, Vector3::Zero(), 0.1}};
}

TEST(FastDrop, NothingPasses) {
  for (const Drop& drop : drops()) {
    for (const double speed : {10.0, 20.0, 40.0}) {
      if (SANITIZED && speed < 40) continue;
      for (const auto& turn : THROWN_TURNS) {
        ThrowScene scene{drop.thrown(), drop.hit(),      speed,          Vector3(turn[0], turn[1], turn[2]),
                         drop.spin,     Vector3::Zero(), drop.both_move, drop.at_rest};
        const ThrowOutcome outcome = throwIt(scene, dynamics::SolverSettings(), [](const auto& step) { step(); });
        SCOPED_TRACE(testing::Message() << drop.name << " " << speed << " m/s, turn " << scene.turn.transpose());
        EXPECT_FALSE(outcome.passed);
        EXPECT_EQ(outcome.pierced_steps, 0);
        EXPECT_LE(outcome.most_substeps, Substeps::MAX_SUBSTEPS);
        EXPECT_LE(outcome.most_redone, 1);
        EXPECT_TRUE(speed > 20 || outcome.redone_steps == 0);
      }
    }
  }
}

TEST(FastDrop, OdesStepperPassesNothingEither) {
  dynamics::SolverSettings solver;
  solver.stepper = "world_step";
  for (const auto& turn : THROWN_TURNS) {
    ThrowScene scene{cubeThrown(), thinSheet(), 20, Vector3(turn[0], turn[1], turn[2])};
    const ThrowOutcome outcome = throwIt(scene, solver, [](const auto& step) { step(); });
    EXPECT_FALSE(outcome.passed);
    EXPECT_EQ(outcome.pierced_steps, 0) << scene.turn.transpose();
  }
}

}  // namespace
}  // namespace blem_sim::sim
