// Bounces through the whole simulation: a cradle of exact spheres, turning cubes of triangles, and the energy that a step says it gained.
#include <algorithm>
#include <cmath>
#include <random>

#include "sim/simulation_scene.h"

namespace blem_sim::sim {
namespace {

constexpr double ANGLE = 0.4, LENGTH = 0.5, RADIUS = 0.02;  // [rad], [m]

std::string hangingBall() {
  return R"(<robot name="ball"><link name="hook"/><link name="ball"><inertial><origin xyz="0 0 -0.5"/><mass value="0.1"/>
    <inertia ixx="1.6e-5" iyy="1.6e-5" izz="1.6e-5" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 -0.5"/><geometry><sphere radius="0.02"/></geometry></collision></link>
    <joint name="hinge" type="continuous"><parent link="hook"/><child link="ball"/><axis xyz="0 1 0"/></joint></robot>)";
}

/** Newton's cradle of five, some of them swung. */
SimulationConfig cradle(int swung, double gap, double time_step) {
  SimulationConfig config;
  config.time_step = time_step;
  config.contact.surface.restitution = 1;
  config.contact.surface.friction = 0;
  for (int i = 0; i < 5; ++i) {
    RobotConfig ball = robot("ball" + std::to_string(i), hangingBall(), true);
    ball.X_WR = makePose({(2 * RADIUS + gap) * i, 0, 1});
    if (i < swung) ball.initial_positions["hinge"] = ANGLE;
    config.robots.push_back(ball);
  }
  return config;
}

struct Bouncing {
  double energy;  ///< [J] kinetic and potential above that of the hanging balls, of the end over that of the start
  double gained;  ///< [J] in a step, at most
  int away;
};

Bouncing halfPeriod(const SimulationConfig& config) {
  Simulator simulator(config, model::UriResolver());
  const double hanging = 5 * 0.1 * G * (1 - LENGTH), start = simulator.report().energy - hanging;
  const double seconds = M_PI * std::sqrt(LENGTH / G * (1 + 0.4 * RADIUS * RADIUS / (LENGTH * LENGTH))) * (1 + ANGLE * ANGLE / 16);
  Bouncing swing{0, 0, 0};
  for (int i = 0; i < std::lround(seconds / config.time_step); ++i) swing.gained = std::max(swing.gained, simulator.step().energy_gained);
  swing.energy = (simulator.report().energy - hanging) / start;
  for (int i = 0; i < 5; ++i) {
    const Vector3 ball = bodyOf(simulator, "ball" + std::to_string(i)).X_WB * Vector3(0, 0, -LENGTH);
    swing.away += ball.z() > 1 - LENGTH * std::cos(0.5 * ANGLE);
  }
  return swing;
}

// The ground bears what lies on it while something bounces off that: a light plate gave way, and the ball stayed where it fell.
TEST(Restitution, ABallBouncesOffWhatLiesOnTheGround) {
  constexpr double FALL = 0.3, E = 0.8, BALL_RADIUS = 0.03;  // [m]
  for (const int plates : {1, 3})
    for (const double mass : {0.01, 0.5, 5.0}) {
      SimulationConfig config;
      config.environments = {ground()};
      double top = 0;
      for (int i = 0; i < plates; ++i) {
        top += i == 0 ? 0.0025 : 0.005;
        config.objects.push_back(box("plate" + std::to_string(i), {0.4, 0.4, 0.02}, mass, {0, 0, top + 0.01}));
        top += 0.02;
      }
      top += 0.0025 + BALL_RADIUS;
      ObjectConfig ball = exactBall("ball", BALL_RADIUS, 0.1);
      ball.contact.restitution = E;
      ball.X_WO = makePose({0.05, 0.02, top + FALL});
      config.objects.push_back(ball);
      Simulator simulator(config, model::UriResolver());
      double apex = 0;
      for (int i = 0; i < 500; ++i) {
        simulator.step();
        if (bodyOf(simulator, "ball").v_WCom.z() > 0) apex = std::max(apex, bodyOf(simulator, "ball").X_WB.translation().z() - top);
      }
      EXPECT_NEAR(apex / FALL, E * E, 1e-4) << plates << " plates of " << mass << " kg";
      EXPECT_LT(bodyOf(simulator, "plate0").v_WCom.norm(), 1e-6) << plates << " plates of " << mass << " kg";
    }
}

class SphereCradle : public ::testing::TestWithParam<double> {};

TEST_P(SphereCradle, KeepsItsEnergyAndAsManyLeaveAsCame) {
  for (const double time_step : {1e-3, 2e-3}) {
    for (int swung = 1; swung <= 3; ++swung) {
      const Bouncing swing = halfPeriod(cradle(swung, GetParam(), time_step));
      EXPECT_NEAR(swing.energy, 1, 0.005) << swung;
      EXPECT_EQ(swing.away, swung);
      // A ball that is hit may fly farther within 2 ms than contacts are known beyond pairs that move; the depth is corrected.
      EXPECT_LT(swing.gained, time_step * 0.9 < GetParam() || GetParam() < 5e-4 ? 1e-6 : 2e-4) << swung;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Gaps, SphereCradle, ::testing::Values(0, 1e-5, 1e-4, 1e-3));

// Steps near the ground are divided: flight and bounces go through parts of changing lengths.
TEST(BouncesInDividedSteps, ComeBackUp) {
  for (const double time_step : {1e-3, 2e-3, 4e-3})
    for (const double height : {0.1, 1.0, 3.0}) {
      SimulationConfig config;
      config.time_step = time_step;
      config.environments = {ground()};
      config.contact.surface.restitution = 1;
      config.contact.surface.friction = 0;
      config.objects = {box("cube", Vector3::Constant(0.1), 1, {0, 0, 0.0525 + height})};
      Simulator simulator(config, model::UriResolver());
      const double fall = std::sqrt(2 * height / G);
      double highest = 0, out_of_nothing = 0;
      for (int i = 0; i < std::lround(6.3 * fall / time_step); ++i) {
        const StepReport& report = simulator.step();
        out_of_nothing = std::max(out_of_nothing, report.energy_out_of_nothing);
        highest = i * time_step < 5 * fall ? 0 : std::max(highest, report.bodies[0].X_WB.translation().z() - 0.0525);
      }
      EXPECT_NEAR(highest / height, 1, 2e-5 + 0.125 * G * time_step * time_step / height) << time_step << " s, " << height << " m";
      EXPECT_LT(out_of_nothing, 1e-9) << time_step << " s, " << height << " m";
    }
}

// Bounces of meshes, whose contacts come and go.
TEST(BouncingMeshes, NeverGain) {
  for (const double restitution : {0.5, 0.8, 1.0}) {
    SimulationConfig config;
    config.environments = {ground()};
    config.contact.surface.restitution = restitution;
    config.contact.surface.friction = restitution < 1 ? 0.3 : 0;
    std::mt19937 random(3);
    const auto any = [&] { return 2 * static_cast<double>(random()) / 0x1p32 - 1; };
    for (int i = 0; i < 3; ++i) {
      ObjectConfig cube = box("cube" + std::to_string(i), Vector3::Constant(0.1), 1, {0, 0, 0.2 + 0.2 * i});
      cube.X_WO.linear() = Eigen::AngleAxisd(any(), Vector3(any(), any(), any()).normalized()).toRotationMatrix();
      cube.angular_velocity = 5 * Vector3(any(), any(), any());
      config.objects.push_back(cube);
    }
    Simulator simulator(config, model::UriResolver());
    const double start = simulator.report().energy;
    double worst = 0, out_of_nothing = 0;
    for (int i = 0; i < 2000; ++i) {
      const StepReport& report = simulator.step();
      worst = std::max(worst, report.energy_gained);
      out_of_nothing = std::max(out_of_nothing, report.energy_out_of_nothing);
    }
    // A corner's slip that the cube's own weight turns round within a step looks like work of friction.
    EXPECT_LT(worst, restitution < 1 ? 1e-5 : 1e-6) << restitution;
    EXPECT_LT(out_of_nothing, 1e-9) << restitution;
    EXPECT_LT(simulator.report().energy, start * (1 + 1e-3)) << restitution;
    if (restitution == 1) {
      EXPECT_GT(simulator.report().energy, 0.95 * start);
    }
  }
}

/** Ball that flies onto the ground askew at 4 m/s, without weight; or onto a heavy plate that flies freely. */
struct AskewBall {
  static constexpr double SLIP = 2.6;  // [m/s] of its surface
  double friction, restitution;
  double height;  ///< [m] which tells where in a step it lands
  double time_step;
  bool onto_plate;

  SimulationConfig config() const {
    SimulationConfig config;
    config.time_step = time_step;
    config.gravity.setZero();
    config.contact.surface.friction = friction;
    config.contact.surface.restitution = restitution;
    config.objects = {exactBall("ball", RADIUS, 0.003)};
    config.objects[0].X_WO = makePose({0, 0, RADIUS + height});
    config.objects[0].linear_velocity = {2, 0, -4};
    config.objects[0].angular_velocity = {0, -0.6 / RADIUS, 0};
    if (onto_plate) config.objects.push_back(box("plate", {4, 4, 0.1}, 3000, {0, 0, -0.0525}));
    if (!onto_plate) config.environments = {ground()};
    return config;
  }
  /** [m/s] That friction takes; it takes no more than what makes the ball roll. */
  double braked() const { return std::min(friction * (1 + restitution) * 4, SLIP / 3.5); }
};

std::vector<AskewBall> askewBalls() {
  std::vector<AskewBall> all;
  for (const double height : {0.05, 0.0513, 0.0529})
    for (const double time_step : {1e-3, 4e-3})
      for (const bool onto_plate : {false, true})
        for (const double friction : {0.1, 1.0})
          for (const double restitution : {0.0, 0.6}) all.push_back({friction, restitution, height, time_step, onto_plate});
  return all;
}

/** Friction acts on the ball's surface, wherever in a step the ball lands: it flies 16 mm in the longest of them. */
TEST(BouncingBalls, TakeTheSpinThatFrictionGives) {
  for (const AskewBall& l : askewBalls()) {
    SCOPED_TRACE(fmt::format("friction {}, e {}, from {} m by {} s, {}", l.friction, l.restitution, l.height, l.time_step, l.onto_plate));
    Simulator simulator(l.config(), model::UriResolver());
    stepFor(&simulator, 0.02);
    const dynamics::BodyState ball = bodyOf(simulator, "ball");
    const double near = l.onto_plate ? 2e-4 : 2e-6;
    EXPECT_NEAR(ball.v_WCom.x(), 2 - l.braked(), near);
    EXPECT_NEAR(ball.w_WB.y() * RADIUS, -0.6 + 2.5 * l.braked(), near);
  }
}

}  // namespace
}  // namespace blem_sim::sim
