// Bounces over twenty seconds, of every restitution and friction, of bodies and trees at random; cradles of every gap and step.
#include <gtest/gtest.h>

#include "dynamics/bouncing_bodies.h"
#include "soak/figures.h"

namespace blem_sim {
namespace {

const Vector3 GRAVITY(0, 0, -9.81);
constexpr double DT = 1e-3;

struct Toss {
  const char* name;
  void (*toss)(BouncingBodies*, int seed);
  bool keeps;  ///< flight keeps its energy to rounding: no gyroscopic torques
};

class SoakBounces : public ::testing::TestWithParam<Toss> {};

TEST_P(SoakBounces, NeverGain) {
  for (const double e : {0.2, 0.5, 0.8, 1.0}) {
    for (const double mu : {0.0, 0.3, 1.0}) {
      Surface surface;
      surface.restitution = e, surface.friction = mu;
      double worst = 0, most = -1, flight = 0;
      for (int seed = 0; seed < (soakShort() ? 2 : 10); ++seed) {
        BouncingBodies scene(GRAVITY, surface, soakSettings());
        GetParam().toss(&scene, seed);
        const EnergyRun run = followEnergy(&scene, DT, soakSteps(20, 3));
        ASSERT_TRUE(run.finite);
        worst = std::max(worst, run.worst);
        flight = std::max(flight, run.worst_flight);
        most = std::max(most, run.end / run.start - 1);
      }
      const std::string name = std::string("bounces of ") + GetParam().name + ", e " + std::to_string(e).substr(0, 3) + ", mu " +
                               std::to_string(mu).substr(0, 3) + ": ";
      figure(name + "largest gain in a step", worst, "J");
      figure(name + "largest change in a step of flight", flight, "J");
      figure(name + "energy at the end, less 1, at most", most, "");
      if (e < 1) EXPECT_LT(most, -0.5);
      if (GetParam().keeps) {
        EXPECT_LT(worst, e == 1 && mu == 0 ? 1e-9 : 1e-4);
        EXPECT_LT(most, 1e-9);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, SoakBounces,
                         ::testing::Values(Toss{"a cube", tossCube, true}, Toss{"two cubes and a ball", tossThree, true},
                                           Toss{"a rod", tossRod, false}, Toss{"a tree", tossTree, false}));

TEST(SoakCradle, KeepsItsEnergyAndAsManyLeaveAsCame) {
  double least = 1, most = 1;
  for (int swung = 1; swung <= 3; ++swung) {
    for (const double gap : {0.0, 1e-5, 1e-4, 1e-3}) {
      for (const double dt : {1e-4, 1e-3, 2e-3}) {
        Cradle cradle(swung, gap);
        const double start = cradle.scene.energy(dt);
        for (int half = 1; half <= 2; ++half) {
          cradle.swing(dt);
          least = std::min(least, cradle.scene.energy(dt) / start);
          most = std::max(most, cradle.scene.energy(dt) / start);
          int away = 0;
          for (int ball = 0; ball < Cradle::BALLS; ++ball) away += std::abs(cradle.angle(ball)) > 0.5 * Cradle::ANGLE;
          EXPECT_EQ(away, swung) << gap << " " << dt;
        }
      }
    }
  }
  figure("cradles: least energy kept", least, "");
  figure("cradles: most", most, "");
  EXPECT_GT(least, 0.98);
  EXPECT_LT(most, 1 + 1e-6);
}

// Balls that turn with their strings slip past each other by radius / length of their speed while they touch: four times.
TEST(SoakCradle, FrictionTakesWhatTheSlipOfTurningBallsIsWorth) {
  const double friction = 0.5, kept = std::pow(1 - 2 * friction * Cradle::RADIUS / Cradle::LENGTH, Cradle::BALLS - 1);
  Cradle cradle(1, 1e-4, friction);
  const double start = cradle.scene.energy(DT);
  cradle.swing(DT);
  figure("cradle, mu 0.5: energy kept over theory", cradle.scene.energy(DT) / start / kept, "");
  EXPECT_NEAR(cradle.scene.energy(DT) / start, kept, 0.01);
}

}  // namespace
}  // namespace blem_sim
