// Bounces over twenty seconds, of every restitution and friction, of bodies and trees at random; cradles of every gap and step.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "dynamics/bouncing_bodies.h"
#include "soak/figures.h"
#include "soak/heap.h"

namespace blem_sim {
namespace {

const Vector3 GRAVITY(0, 0, -9.81);
constexpr double DT = 1e-3;
constexpr double MOST_GAIN = 1e-6;  // [J] in a step

struct Toss {
  const char* name;
  void (*toss)(dynamics::BouncingBodies*, int seed);
};

/** The worst of some runs. */
struct TossOutcome {
  double worst = 0, gain = 0;   ///< [J] in a step: EnergyRun::worst, worst_gain
  double least = 0, most = -1;  ///< energy at the end over that of the start, less 1
  double flight = 0;            ///< [J] largest change in a step of flight
};

TossOutcome tossAll(const Toss& toss, const dynamics::Surface& surface) {
  TossOutcome outcome;
  for (int seed = 0; seed < (soakShort() ? 2 : 10); ++seed) {
    dynamics::BouncingBodies scene(GRAVITY, surface, soakSettings());
    toss.toss(&scene, seed);
    const dynamics::EnergyRun run = dynamics::followEnergy(&scene, DT, soakSteps(20, 3));
    EXPECT_TRUE(run.finite) << seed;
    outcome.worst = std::max(outcome.worst, run.worst);
    outcome.gain = std::max(outcome.gain, run.worst_gain);
    outcome.flight = std::max(outcome.flight, run.worst_flight);
    outcome.least = std::min(outcome.least, run.end / run.start - 1);
    outcome.most = std::max(outcome.most, run.end / run.start - 1);
  }
  return outcome;
}

class SoakBounces : public ::testing::TestWithParam<Toss> {};

TEST_P(SoakBounces, NeverGain) {
  for (const double e : {0.2, 0.5, 0.8, 1.0}) {
    for (const double mu : {0.0, 0.3, 1.0}) {
      dynamics::Surface surface;
      surface.restitution = e, surface.friction = mu;
      const TossOutcome outcome = tossAll(GetParam(), surface);
      const std::string name = std::string("bounces of ") + GetParam().name + ", e " + std::to_string(e).substr(0, 3) + ", mu " +
                               std::to_string(mu).substr(0, 3) + ": ";
      figure(name + "largest rise in a step", outcome.worst, "J");
      figure(name + "largest gain in a step", outcome.gain, "J");
      figure(name + "largest change in a step of flight", outcome.flight, "J");
      figure(name + "energy at the end, less 1, at most", outcome.most, "");
      const bool keeps = e == 1 && mu == 0;
      EXPECT_GT(outcome.least, keeps ? -0.01 : -1);  // the slowest touches rest
      EXPECT_LT(outcome.most, e < 1 ? -0.5 : 1e-9);
      EXPECT_LT(outcome.worst, keeps ? 1e-9 : 1e-4);
      EXPECT_LT(outcome.gain, keeps ? 1e-9 : MOST_GAIN) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, SoakBounces,
                         ::testing::Values(Toss{"a cube", dynamics::tossCube}, Toss{"two cubes and a ball", dynamics::tossThree},
                                           Toss{"a rod", dynamics::tossRod}, Toss{"a tree", dynamics::tossTree}));

/** A scene of meshes or exact spheres, thrown as the seed says. */
struct Throw {
  const char* name;
  void (*fill)(sim::SimulationConfig*, const std::function<double()>& any);
  double most;  ///< [J] out of nothing in a step
};

/** An object turned and spinning at random. @param any a number from -1 to 1 */
sim::ObjectConfig thrown(sim::ObjectConfig object, const std::function<double()>& any) {
  const double x = any(), y = any(), z = any();
  object.X_WO.linear() = makePose(Vector3::Zero(), 3 * Vector3(x, y, z)).linear();
  object.angular_velocity = 5 * Vector3(z, x, y);
  return object;
}

void boxOnBox(sim::SimulationConfig* config, const std::function<double()>& any) {
  config->environments = {sim::ground()};
  config->objects.push_back(sim::box("low", {0.3, 0.3, 0.1}, 3, {0, 0, 0.0525}));
  config->objects.push_back(thrown(sim::box("high", Vector3::Constant(0.1), 1, {0.02 * any(), 0.02 * any(), 0.5}), any));
}

void tenBalls(sim::SimulationConfig* config, const std::function<double()>& any) {
  const sim::SimulationConfig poured = spheresInBin(10, 1 + static_cast<int>(1000 * (1 + any())), config->solver);
  config->environments = poured.environments;
  config->objects = poured.objects;
  for (sim::ObjectConfig& ball : config->objects) ball.linear_velocity = {any(), any(), any()};
}

/** An arm of two bars on free hinges, and a cube that falls onto it. */
void cubeOnArm(sim::SimulationConfig* config, const std::function<double()>& any) {
  const auto bar = [](const std::string& name) {
    return "<link name=\"" + name + R"("><inertial><origin xyz="0.15 0 0"/><mass value="1"/>
      <inertia ixx="0.0007" iyy="0.008" izz="0.008" ixy="0" ixz="0" iyz="0"/></inertial>
      <collision><origin xyz="0.15 0 0"/><geometry><box size="0.28 0.06 0.06"/></geometry></collision></link>)";
  };
  const std::string urdf = "<robot name=\"arm\"><link name=\"base\"/>" + bar("upper") + bar("lower") +
                           R"(<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
      <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="0.32 0 0"/><axis xyz="0 1 0"/></joint>
      </robot>)";
  config->environments = {sim::ground()};
  config->robots = {sim::robot("arm", urdf, true)};
  config->robots[0].X_WR = makePose({0, 0, 0.6});
  config->objects.push_back(thrown(sim::box("cube", Vector3::Constant(0.1), 0.5, {0.3 + 0.05 * any(), 0.02 * any(), 1}), any));
}

class SoakBouncesInScenes : public ::testing::TestWithParam<Throw> {};

TEST_P(SoakBouncesInScenes, NeverGain) {
  for (const double e : {0.8, 1.0}) {
    for (const double mu : {0.0, 0.3}) {
      double out_of_nothing = 0, gained = 0;
      int told = 0;
      for (int seed = 0; seed < (soakShort() ? 2 : 10); ++seed) {
        std::mt19937 random(seed);
        sim::SimulationConfig config;
        config.solver = soakSettings();
        config.contact.surface.restitution = e, config.contact.surface.friction = mu;
        GetParam().fill(&config, [&random] { return 2 * static_cast<double>(random()) / 0x1p32 - 1; });
        sim::Simulator simulator(config, model::UriResolver());
        for (int k = 0; k < soakSteps(4, 1); ++k) {
          const sim::StepReport& report = simulator.step();
          ASSERT_FALSE(report.status & sim::STATE_NOT_FINITE);
          out_of_nothing = std::max(out_of_nothing, report.energy_out_of_nothing);
          gained = std::max(gained, report.energy_gained);
          told += (report.status & sim::ENERGY_GAINED) != 0;
        }
      }
      const std::string name =
          std::string(GetParam().name) + ", e " + std::to_string(e).substr(0, 3) + ", mu " + std::to_string(mu).substr(0, 3);
      figure(name + ": energy gained in a step, corrections of depth included", gained, "J");
      figure(name + ": out of nothing in a step", out_of_nothing, "J");
      figure(name + ": steps that said ENERGY_GAINED", told, "");
      EXPECT_LT(out_of_nothing, GetParam().most) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SoakBouncesInScenes,
                         ::testing::Values(Throw{"a cube on a box", boxOnBox, MOST_GAIN}, Throw{"ten balls in a bin", tenBalls, MOST_GAIN},
                                           Throw{"a cube on an arm", cubeOnArm, MOST_GAIN}));

TEST(SoakCradle, KeepsItsEnergyAndAsManyLeaveAsCame) {
  double least = 1, most = 1;
  for (int swung = 1; swung <= 3; ++swung) {
    for (const double gap : {0.0, 1e-5, 1e-4, 1e-3}) {
      for (const double dt : {1e-4, 1e-3, 2e-3}) {
        dynamics::Cradle cradle(swung, gap);
        const double start = cradle.scene.energy(dt);
        for (int half = 1; half <= 2; ++half) {
          cradle.swing(dt);
          least = std::min(least, cradle.scene.energy(dt) / start);
          most = std::max(most, cradle.scene.energy(dt) / start);
          int away = 0;
          for (int ball = 0; ball < dynamics::Cradle::BALLS; ++ball) away += std::abs(cradle.angle(ball)) > 0.5 * dynamics::Cradle::ANGLE;
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
  const double friction = 0.5,
               kept = std::pow(1 - 2 * friction * dynamics::Cradle::RADIUS / dynamics::Cradle::LENGTH, dynamics::Cradle::BALLS - 1);
  dynamics::Cradle cradle(1, 1e-4, friction);
  const double start = cradle.scene.energy(DT);
  cradle.swing(DT);
  figure("cradle, mu 0.5: energy kept over theory", cradle.scene.energy(DT) / start / kept, "");
  EXPECT_NEAR(cradle.scene.energy(DT) / start, kept, 0.01);
}

}  // namespace
}  // namespace blem_sim
