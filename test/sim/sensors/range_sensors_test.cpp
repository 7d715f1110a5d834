// Depth cameras and lidars against closed forms, and against all triangles of a scan.
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "blem_sim/geometry/closest_points.h"
#include "blem_sim/sim/range_view.h"
#include "sim/sensors/range_scene.h"
#include "support/sanitizers.h"
#include "support/shared_data.h"

namespace blem_sim::sim {
namespace {

constexpr float NOTHING = std::numeric_limits<float>::infinity();

TEST(DepthCamera, PlaneAheadIsAtOneDepthEverywhere) {
  SimulationConfig config = sceneWith(depthCamera());
  config.environments = {halfSpace({-1, 0, 0, -2})};
  config.robots[0].sensors[0].rays.hfov = 0.4;
  for (const float depth : depthsIn(config)) EXPECT_NEAR(depth, 2, 1e-6);
}

TEST(DepthCamera, FloorGrowsDownwardsAndLeftIsLeft) {
  SimulationConfig config = sceneWith(depthCamera());
  config.environments = {halfSpace({0, 0, 1, -0.5})};
  const RangeSensorConfig& rays = config.robots[0].sensors[0].rays;
  const contact::Pinhole pinhole = pinholeOf(rays);
  EXPECT_NEAR(std::atan(rays.width / 2.0 / pinhole.focal_length), rays.hfov / 2, 1e-15);
  const std::vector<float> depths = depthsIn(config);
  int floor = 0, fin = 0;
  for (int v = 0; v < rays.height; ++v) {
    for (int u = 0; u < rays.width; ++u) {
      const float depth = depths[static_cast<std::size_t>(v) * rays.width + u];
      const double down = (v - pinhole.middle_v) / pinhole.focal_length, expected = 0.5 / down;
      if (down <= 0 || expected > 5) {
        EXPECT_TRUE(std::isnan(depth)) << "column " << u << ", row " << v;
        continue;
      }
      EXPECT_NEAR(depth, expected, 1e-6);
      ++floor;
    }
  }
  EXPECT_GT(floor, 100);
  // The fin, nearer than 0.4 m, is the robot's own; from 0.1 m on it is seen on the left.
  config.robots[0].sensors[0].rays.nearest = 0.1;
  config.robots[0].sensors[0].rays.hfov = 2.4;
  const std::vector<float> with_fin = depthsIn(config);
  for (std::size_t i = 0; i < with_fin.size(); ++i) {
    if (!(std::abs(with_fin[i] - 0.19) <= 1e-6)) continue;
    ++fin;
    EXPECT_LT(static_cast<int>(i) % rays.width, rays.width / 2);
  }
  EXPECT_GT(fin, 0);
}

TEST(DepthCamera, SphereBoxAndLayer) {
  const char* const BALL = R"(<robot name="ball"><link name="ball">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.3"/></geometry></collision></link></robot>)";
  SimulationConfig config = sceneWith(depthCamera());
  config.robots.push_back(robot("ball", BALL, true));
  config.robots[1].X_WR = makePose({2, 0, 0});
  const contact::Pinhole pinhole = pinholeOf(config.robots[0].sensors[0].rays);
  const std::vector<float> depths = depthsIn(config);
  int hits = 0;
  for (int v = 0; v < 17; ++v) {
    for (int u = 0; u < 33; ++u) {
      // Depth z of (x, y, 1) z at the sphere: |z d - (0, 0, 2)| = 0.3.
      const double x = (u - pinhole.middle_u) / pinhole.focal_length, y = (v - pinhole.middle_v) / pinhole.focal_length;
      const double a = x * x + y * y + 1, root = 4 - a * (4 - 0.09);
      const float depth = depths[static_cast<std::size_t>(v) * 33 + u];
      ASSERT_EQ(std::isnan(depth), root < 0);
      if (root < 0) continue;
      ++hits;
      EXPECT_NEAR(depth, (2 - std::sqrt(root)) / a, 1e-6);
    }
  }
  EXPECT_GT(hits, 20);
  // A box is seen bare: its layer is no surface.
  config.robots.pop_back();
  config.objects = {box("box", {0.2, 0.2, 0.2}, 1, {1, 0, 0})};
  EXPECT_NEAR(depthsIn(config)[8 * 33 + 16], 0.9, 1e-6);
}

TEST(DepthCamera, LooksThroughTheMiddleOfItsImage) {
  SimulationConfig config = sceneWith(depthCamera());
  config.environments = {halfSpace({-0.8, 0, -0.6, -1.6})};  // depth grows downwards alone
  config.robots[0].sensors[0].rays.hfov = 0.4;
  const std::vector<float> depths = depthsIn(config);
  EXPECT_NEAR(depths[8 * 33 + 16], 2, 1e-6);
  EXPECT_LT(depths[0], depths[16 * 33] - 0.01);
}

TEST(DepthCamera, SitsWhereItsPoseSays) {
  SimulationConfig config = sceneWith(depthCamera());
  config.robots[0].X_WR = makePose({0, 0, 1});
  config.robots[0].sensors[0].X_LS = makePose({0, 0, 0.5}, {0, M_PI / 2, 0});
  config.robots[0].sensors[0].rays.hfov = 0.2;
  config.environments = {halfSpace({0, 0, 1, 0})};
  for (const float depth : depthsIn(config)) EXPECT_NEAR(depth, 1.5, 1e-6) << "looking down";
}

TEST(Lidar, WallBehindTheNearAndFarLimits) {
  SimulationConfig config = sceneWith(lidar());
  config.environments = {halfSpace({-1, 0, 0, -2})};
  const std::vector<float> ranges = rangesIn(config);
  const RangeSensorConfig& rays = config.robots[0].sensors[0].rays;
  for (int beam = 0; beam < rays.beams; ++beam) {
    const double angle = beamAngle(rays, beam), wall = 2 / std::cos(angle);
    // The fin spans 0.2 to 0.8 m on the left, 0.19 m ahead.
    const bool fin = angle > std::atan2(0.2, 0.21) && angle < std::atan2(0.8, 0.19);
    if (fin) continue;
    if (wall > 30) {
      EXPECT_EQ(ranges[beam], NOTHING) << angle;
    } else {
      EXPECT_NEAR(ranges[beam], wall, 1e-6 * wall) << angle;
    }
  }
  EXPECT_NEAR(ranges[135], 0.2 * std::sqrt(2.0), 1e-6) << "the side of the own fin";
}

TEST(Lidar, OwnLinksThatAreTooNearAreSeenThroughOthersAreNot) {
  SimulationConfig config = sceneWith(lidar());
  config.environments = {halfSpace({-1, 0, 0, -2})};
  config.robots[0].sensors[0].rays.nearest = 0.5;
  EXPECT_NEAR(rangesIn(config)[135], 2 * std::sqrt(2.0), 1e-6);
  config.objects = {box("box", {0.2, 0.2, 0.2}, 1, {0.3, 0, 0})};
  EXPECT_EQ(rangesIn(config)[90], -NOTHING);
}

TEST(Lidar, LayersFromTheLowest) {
  SimulationConfig config = sceneWith(lidar());
  RangeSensorConfig& rays = config.robots[0].sensors[0].rays;
  rays.layers = 3;
  rays.lowest_angle = -0.2;
  rays.highest_angle = 0.2;
  rays.beams = 11;
  config.environments = {halfSpace({0, 0, 1, -1})};
  const std::vector<float> ranges = rangesIn(config);
  ASSERT_EQ(ranges.size(), 33u);
  EXPECT_NEAR(ranges[5], 1 / std::sin(0.2), 1e-5);
  EXPECT_EQ(ranges[11 + 5], NOTHING);
  EXPECT_EQ(ranges[22 + 5], NOTHING);
}

TEST(RangeView, IsDrawnAsItWasTaken) {
  SimulationConfig config = sceneWith(lidar());
  config.objects = {box("box", {0.2, 0.2, 0.2}, 1, {2, 0, 0})};
  config.objects[0].linear_velocity = {5, 0, 0};
  Simulator simulator(config, model::UriResolver());
  const auto view = reading<LidarReading>(simulator.step(), 0).view;
  stepFor(&simulator, 0.2);
  EXPECT_NEAR(rangesOf(*view)[90], 1.9 + 0.005, 1e-6);
  EXPECT_NEAR(rangesOf(*reading<LidarReading>(simulator.report(), 0).view)[90], 1.9 + 5 * 0.201, 1e-5);
}

TEST(RangeView, IsTheSameForAnyNumberOfThreads) {
  SimulationConfig config = sceneWith(depthCamera());
  config.environments = {halfSpace({0, 0, 1, -0.5})};
  config.robots[0].sensors[0].rays.noise = RangeNoise::KINECT;
  config.robots[0].sensors[0].rays.width = 320;
  config.robots[0].sensors[0].rays.height = 240;
  Simulator simulator(config, model::UriResolver());
  const auto view = reading<DepthCameraReading>(simulator.step(), 0).view;
  const auto drawnBy = [&](int threads) { return tbb::task_arena(threads).execute([&] { return depthsOf(*view); }); };
  const std::vector<float> one = drawnBy(1), four = drawnBy(4);
  ASSERT_EQ(one.size(), four.size());
  EXPECT_EQ(std::memcmp(one.data(), four.data(), one.size() * sizeof(float)), 0);
}

/** Depth of the nearest triangle along a ray, by Cramer's rule for every one. */
double nearestDepth(const std::vector<geometry::Triangle>& triangles, const geometry::Ray& ray) {
  double best = std::numeric_limits<double>::infinity();
  for (const geometry::Triangle& t : triangles) {
    const Vector3 ab = t[1] - t[0], ac = t[2] - t[0], p = ray.direction.cross(ac), s = ray.origin - t[0];
    const double det = ab.dot(p);
    if (det == 0) continue;
    const double u = s.dot(p) / det, v = ray.direction.dot(s.cross(ab)) / det, depth = ac.dot(s.cross(ab)) / det;
    if (u >= -1e-9 && v >= -1e-9 && u + v <= 1 + 1e-9 && depth >= 0) best = std::min(best, depth);
  }
  return best;
}

TEST(DepthCamera, EveryRayOnAScanIsThatOfAllItsTriangles) {
  const std::string file = "scans/synthetic_kinect/stepladder_150k.ply";
  SKIP_WITHOUT_SHARED_DATA(file);
  SimulationConfig config = sceneWith(depthCamera());
  config.robots[0].X_WR = makePose({2.5, 0.3, 1.2}, {0, 0.3, M_PI});
  EnvironmentConfig scan;
  scan.name = "scan";
  scan.uri = *sharedData(file);
  config.environments = {scan};
  Simulator simulator(config, model::UriResolver());
  simulator.step();
  const auto view = reading<DepthCameraReading>(simulator.report(), 0).view;
  const std::vector<float> depths = depthsOf(*view);
  std::vector<geometry::Triangle> triangles;
  for (const contact::Collider& collider : simulator.colliders()) {
    if (collider.model == view->model) continue;
    for (int i = 0; i < static_cast<int>(collider.geometry->mesh().elements.size()); ++i)
      triangles.push_back(geometry::triangleOf(collider.geometry->mesh(), i));
  }
  const contact::Pinhole pinhole = pinholeOf(view->rays);
  int hits = 0;
  for (int i = 0; i < static_cast<int>(depths.size()); i += SANITIZED ? 7 : 1) {
    const double x = (i % 33 - pinhole.middle_u) / pinhole.focal_length, y = (i / 33 - pinhole.middle_v) / pinhole.focal_length;
    const double expected = nearestDepth(triangles, {view->X_WS.translation(), view->X_WS.linear() * Vector3(1, -x, -y)});
    if (expected < 0.4 || expected > 5) {
      EXPECT_TRUE(std::isnan(depths[i])) << i;
      continue;
    }
    ++hits;
    EXPECT_NEAR(depths[i], expected, 1e-6) << i;
  }
  EXPECT_GT(hits, samples(100));
}

}  // namespace
}  // namespace blem_sim::sim
