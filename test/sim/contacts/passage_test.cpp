// Nothing passes unsaid: bodies at rest that are hit, driven bodies, large steps, and anything at random (scripts/validate_throws: 10,000).
#include "guard/step_guard.h"
#include "support/sanitizers.h"
#include "support/throw_scene.h"

namespace blem_sim::sim {
namespace {

/** Passages of bodies through a wall below them, and whether they were said and told. */
struct Watched {
  bool behind = false, unsaid = false, untold = false;
};

/** @param body name of the body that must stay over z = 0 */
Watched watch(const SimulationConfig& config, const std::string& body, int steps, const JointCommandMessage& command = {}) {
  Simulator simulator(config, model::UriResolver());
  if (!command.joints.empty()) simulator.commandJoints(0, command);
  const Wall wall = Wall::below(simulator, "ground", 0);
  const int collider = colliderOf(simulator, body);
  Watched watched;
  bool said = false, told = false;
  for (int i = 0; i < steps; ++i) {
    const StepReport& report = simulator.step();
    EXPECT_LE(report.substeps + report.redone_solves, Substeps::MAX_SOLVES);
    said = said || (report.status & CONTACT_UNRELIABLE);
    for (const LayerEventReport& event : report.layer_events) told = told || event.outside;
    watched.unsaid = watched.unsaid || (watched.behind && !said);
    watched.untold = watched.untold || (watched.behind && !told);
    watched.behind = watched.behind || behind(simulator, wall, collider) != Behind::NOTHING;
  }
  return watched;
}

/** A plate of 10 g at rest 5 mm over a sheet, 10 kg over it. @param thickness [m] of the plate, 0: two triangles */
SimulationConfig hitPlate(double thickness, double gap, double speed, double restitution) {
  SimulationConfig config;
  config.contact.surface.restitution = restitution;
  config.environments = {ground()};
  ObjectConfig plate = box("plate", {0.1, 0.1, std::max(thickness, 0.001)}, 0.01, {0, 0, 0.005 + 0.5 * thickness});
  if (thickness == 0) plate.uri = meshFile("resting_plate", geometry::gridMesh(0.1, 0.1, 1, 1));
  ObjectConfig hitter = box("hitter", Vector3::Constant(0.1), 10, Vector3::Zero());
  hitter.X_WO = makePose({0, 0, 0.005 + thickness + 0.005 + gap + 0.05});
  hitter.linear_velocity = {0, 0, -speed};
  config.objects = {plate, hitter};
  return config;
}

TEST(Passage, PlateAtRestOverASheetThatIsHitStaysAboveIt) {
  for (const double thickness : {0.0, 0.001, 0.003, 0.006}) {
    for (const double speed : {5.0, 10.0, 20.0}) {
      for (const double gap : SANITIZED ? std::vector<double>{0.005} : std::vector<double>{0.0005, 0.002, 0.005, 0.01, 0.02}) {
        for (const double restitution : {0.0, 0.3, 0.6}) {
          SCOPED_TRACE(testing::Message() << 1e3 * thickness << " mm thick, " << speed << " m/s, gap " << 1e3 * gap << " mm, e "
                                          << restitution);
          const Watched plate = watch(hitPlate(thickness, gap, speed, restitution), "plate", 15);
          EXPECT_FALSE(plate.behind);
          EXPECT_FALSE(plate.unsaid);
          EXPECT_FALSE(plate.untold);
        }
      }
    }
  }
}

std::string paddleUrdf(double mass, double effort) {
  const double i = mass / 12 * 0.01;
  return fmt::format(
      R"(<robot name="driver"><link name="base"/><link name="paddle"><inertial><mass value="{}"/>
         <inertia ixx="{}" iyy="{}" izz="{}" ixy="0" ixz="0" iyz="0"/></inertial>
         <collision><geometry><box size="0.1 0.1 0.01"/></geometry></collision></link>
         <joint name="slide" type="prismatic"><parent link="base"/><child link="paddle"/><axis xyz="0 0 -1"/>
         <limit lower="-1" upper="1" effort="{}" velocity="1e3"/></joint></robot>)",
      mass, i, i, 2 * i, effort);
}

TEST(Passage, PaddleDrivenAtASheetStopsThere) {
  for (const JointGains& gains : {JointGains{1e5, 0, 2000}, JointGains{2000, 0, 60}, JointGains{1e5, 0, 200}}) {
    for (const double mass : {0.1, 0.3, 1.5}) {
      for (const double effort : {300.0, 1e6}) {
        for (const double gap : {0.005, 0.01, 0.03, 0.06, 0.1}) {
          SCOPED_TRACE(testing::Message() << "p " << gains.p << " d " << gains.d << ", " << mass << " kg, " << effort << " N, " << gap
                                          << " m");
          SimulationConfig config;
          config.environments = {ground()};
          config.robots = {robot("driver", paddleUrdf(mass, effort), true)};
          config.robots[0].X_WR = makePose({0, 0, 0.005 + gap});
          config.robots[0].gains["slide"] = gains;
          config.robots[0].motor["slide"] = MotorLaw::IMPLICIT_PD;
          const Watched paddle = watch(config, "driver", 60, {{"slide"}, {0.2}, {}, {}});
          EXPECT_FALSE(paddle.behind);
          EXPECT_FALSE(paddle.unsaid);
          EXPECT_FALSE(paddle.untold);
        }
      }
    }
  }
}

TEST(Passage, LargeStepsStopWhatIsSmallOrSaySo) {
  for (const double dt : {0.005, 0.01}) {
    for (const bool ball : {true, false}) {
      for (int i = 0; i < 12; ++i) {
        SimulationConfig config;
        config.time_step = dt;
        config.environments = {ground()};
        ObjectConfig small = box("small", Vector3::Constant(0.003), 0.001, {0.01, 0.02, 0.11 + 0.037 * i});
        if (ball) small.uri = meshFile("ball_2mm", geometry::icosphereMesh(0.002, 1));
        small.linear_velocity = {0, 0, -40};
        config.objects = {small};
        SCOPED_TRACE(testing::Message() << (ball ? "ball" : "cube") << ", " << dt << " s, height " << small.X_WO.translation().z());
        const Watched watched = watch(config, "small", 12);
        EXPECT_FALSE(watched.unsaid);
        EXPECT_FALSE(watched.untold);
      }
    }
  }
}

class ThrownScenes : public ::testing::TestWithParam<int> {};

TEST_P(ThrownScenes, PassNothingUnsaid) {
  const int count = samples(20);
  for (int i = 0; i < count; ++i) {
    const auto seed = static_cast<std::uint64_t>(1 + GetParam() * count + i);
    const ThrownScene scene = thrownScene(seed);
    const ThrownOutcome outcome = runThrownScene(scene);
    SCOPED_TRACE(testing::Message() << scene.description << "\nscripts/validate_throws --seed " << seed);
    EXPECT_FALSE(outcome.unsaid);
    EXPECT_FALSE(outcome.untold);
    EXPECT_FALSE(outcome.passed && scene.default_widths && scene.config.time_step <= 0.001 && outcome.fastest <= 20);
    EXPECT_LE(outcome.most_solves, Substeps::MAX_SOLVES);
  }
}
INSTANTIATE_TEST_SUITE_P(Groups, ThrownScenes, ::testing::Range(0, 20));

}  // namespace
}  // namespace blem_sim::sim
