// A ball dropped into a mug as a stereo camera saw it, from one side, stays in it: points and triangles. The lower half of the back wall
// was not seen, so the table leans towards the camera.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sim/simulation_scene.h"
#include "support/sanitizers.h"
#include "support/shared_data.h"

namespace blem_sim::sim {
namespace {

constexpr const char* MUG = "scans/real/stereomug_mug.ply";  // 28,628 triangles; the table is z = 0, what is below 15 mm was cut
constexpr double MUG_BALL = 0.024;                           // [m] radius
constexpr double LEAN = 0.5;                                 // [rad]
const Vector3 MIDDLE(-0.002, 0.013, 0);                      // [m] of the rim

SimulationConfig mugConfig(model::CloudOptions::As as, bool exact_ball, double direction) {
  SimulationConfig config;
  EnvironmentConfig mug;
  mug.name = "mug";
  mug.uri = *sharedData(MUG);
  mug.cloud.as = as;
  mug.cloud.auto_radius = true;
  config.environments = {mug, ground(1)};
  config.gravity = G * Vector3(-std::sin(LEAN), 0, -std::cos(LEAN));
  ObjectConfig ball = exactBall("ball", MUG_BALL, 0.05);
  if (!exact_ball) {
    ball.urdf_xml.clear();
    ball.uri = meshFile("ball_for_mug", geometry::icosphereMesh(MUG_BALL - config.contact.boundary_width.metres, 2));
  }
  ball.X_WO = makePose(MIDDLE + Vector3(0.004, 0, 0.115));
  ball.linear_velocity = 0.1 * Vector3(std::cos(direction), std::sin(direction), 0);
  config.objects = {ball};
  return config;
}

TEST(MugCloud, ABallDroppedIntoItStaysIn) {
  SKIP_WITHOUT_SHARED_DATA(MUG);
  double farthest = 0, highest = 0;
  for (const auto as : {model::CloudOptions::As::POINTS, model::CloudOptions::As::MESH})
    for (const bool exact_ball : {true, false})
      for (int direction = 0; direction < 8; ++direction) {
        if (SANITIZED && (direction > 0 || !exact_ball)) continue;
        Simulator simulator(mugConfig(as, exact_ball, direction * M_PI / 4), model::UriResolver());
        double max_of_layer = 0;
        for (int i = 0; i < 1000; ++i) {
          const StepReport& report = simulator.step();
          max_of_layer = std::max(max_of_layer, report.max_of_layer);
          ASSERT_FALSE(report.status & (CONTACT_UNRELIABLE | STATE_NOT_FINITE)) << report.time;
        }
        const Vector3 end = bodyOf(simulator, "ball").X_WB.translation() - MIDDLE;
        farthest = std::max(farthest, end.head<2>().norm());
        highest = std::max(highest, end.z());
        EXPECT_LT(end.head<2>().norm(), 0.018) << direction << " " << exact_ball << " " << end.transpose();
        EXPECT_LT(end.z(), MUG_BALL + 0.03) << direction << " " << exact_ball << " " << end.transpose();
        EXPECT_GT(end.z(), MUG_BALL - 0.001) << direction << " " << exact_ball;
        EXPECT_LT(max_of_layer, 1);
      }
  std::printf("at the end at most %.1f mm off the middle, %.1f mm over the table\n", 1e3 * farthest, 1e3 * (highest - MUG_BALL));
}

}  // namespace
}  // namespace blem_sim::sim
