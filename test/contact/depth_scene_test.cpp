// Depth images against rays that look for their triangles, pixel by pixel and bit by bit.
#include "blem_sim/contact/depth_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "blem_sim/geometry/ray_cast.h"
#include "geometry/random_shapes.h"
#include "kernels/kernels.h"
#include "ray_turns.h"

namespace blem_sim::contact {
namespace {

constexpr double NO_DEPTH = std::numeric_limits<double>::infinity();

RayTarget placed(const geometry::TriangleMesh& mesh, const Pose& X_WC, int model = 0) {
  return {std::make_shared<const CollisionGeometry>(std::make_shared<const geometry::TriangleMesh>(mesh)), X_WC, 0.0025, model};
}

/** A camera of odd sizes: neither whole tiles nor whole bands. */
PinholeRays camera(const Pose& X_WS) { return {{83, 39, 60.0, 41.3, 18.7}, X_WS}; }

std::vector<double> drawn(const DepthScene& scene, const PinholeRays& rays, const RayScene::Query& query) {
  const int width = rays.pinhole.width, height = rays.pinhole.height;
  std::vector<double> depths;
  for (int band = 0; band * DepthScene::BAND_ROWS < height; ++band) {
    std::vector<double> rows(static_cast<std::size_t>(std::min(DepthScene::BAND_ROWS, height - band * DepthScene::BAND_ROWS)) * width);
    scene.drawBand(rays, query, band, rows.data());
    depths.insert(depths.end(), rows.begin(), rows.end());
  }
  return depths;
}

/** Pixels that hit something; each depth is compared with its ray's own. */
int compare(const std::vector<RayTarget>& targets, const PinholeRays& rays, const RayScene::Query& query) {
  const RayScene alone(targets);
  const std::vector<double> depths = drawn(DepthScene(targets), rays, query);
  int hits = 0;
  for (int row = 0; row < rays.pinhole.height; ++row)
    for (int column = 0; column < rays.pinhole.width; ++column) {
      RayFan fan{rays.X_WS.translation(), {}};
      fan.directions.fill(rays.direction(row, column));
      const double expected = alone.firstHits(fan, query)[0].t, depth = depths[row * rays.pinhole.width + column];
      EXPECT_EQ(depth, expected) << "row " << row << ", column " << column;
      if (depth != expected) return -1;
      hits += expected < NO_DEPTH;
    }
  return hits;
}

TEST(DepthScene, IsWhatEachRayMeetsFirst) {
  geometry::RandomShapes random(31);
  int hits = 0;
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<RayTarget> targets;
    for (int i = 0; i < 12; ++i) {
      const geometry::TriangleMesh shapes[] = {geometry::boxMesh({0.6, 0.4, 0.2}), geometry::icosphereMesh(0.3, 3),
                                               geometry::pointMesh({0.1, 0, 0}), geometry::icosphereMesh(0.02, 1)};
      targets.push_back(placed(shapes[i % 4], random.pose(1.5), i % 3));
      if (i % 4 == 2) targets.back().radius = 0.15;
    }
    if (trial % 3 == 0) targets.push_back({CollisionGeometry::halfSpace({0.1, 0, 1}, -1.5), Pose::Identity(), 0, 5});
    // Cameras stand between and inside of things.
    const int found = compare(targets, camera(random.pose(1.5)), {random.uniform(0, 5), trial % 3, random.uniform(0, 1)});
    ASSERT_GE(found, 0) << "trial " << trial;
    hits += found;
  }
  EXPECT_GT(hits, 10000);
}

TEST(DepthScene, SeesTrianglesOfAllSizesNearAndFar) {
  geometry::RandomShapes random(5);
  const double sizes[] = {5e-3, 0.02, 0.3, 20.0};
  const int least_hits[] = {15, 200, 3000, 3000};
  for (int s = 0; s < 4; ++s) {
    geometry::TriangleMesh soup;
    for (int i = 0; i < 4000; ++i) {
      const Vector3 middle(random.uniform(0.2, 4), random.uniform(-1, 1), random.uniform(-1, 1));
      const int first = static_cast<int>(soup.vertices.size());
      for (int k = 0; k < 3; ++k) soup.vertices.push_back(middle + random.point(sizes[s]));
      soup.elements.emplace_back(first, first + 1, first + 2);
    }
    const Pose X_WC = random.pose(100);
    EXPECT_GE(compare({placed(soup, X_WC)}, camera(X_WC * makePose({0, 0.1, 0}, {0.2, 0.1, 0.3})), {}), least_hits[s]) << sizes[s] << " m";
  }
}

TEST(DepthScene, SeesAFineSurfaceWithoutAHole) {
  geometry::RandomShapes random(8);
  geometry::TriangleMesh grid = geometry::gridMesh(6, 6, 300, 300);
  for (Vector3& v : grid.vertices) v.z() = random.uniform(-2e-3, 2e-3);
  const PinholeRays rays = camera(makePose({0.1, 0.2, 1.2}, {0.3, M_PI / 2, 0}));
  EXPECT_EQ(compare({placed(grid, Pose::Identity())}, rays, {}), rays.pinhole.width * rays.pinhole.height);
  EXPECT_EQ(compare({placed(geometry::boxMesh({40, 40, 1}), makePose({0, 0, -0.5}))}, rays, {}), rays.pinhole.width * rays.pinhole.height)
      << "two triangles fill the image";
}

TEST(DepthScene, SeesTheNearerOfSurfacesThatPassThroughEachOther) {
  geometry::RandomShapes random(9);
  geometry::TriangleMesh both;
  for (int sheet = 0; sheet < 2; ++sheet) {
    const geometry::TriangleMesh grid = geometry::gridMesh(2, 2, 200, 200);
    const Vector3i first = Vector3i::Constant(static_cast<int>(both.vertices.size()));
    for (const Vector3& v : grid.vertices) both.vertices.push_back(v + Vector3(0, 0, random.uniform(-5e-3, 5e-3)));
    for (const Vector3i& element : grid.elements) both.elements.push_back(element + first);
  }
  for (const double turn : {0.5, 0.9, 1.4}) {
    const PinholeRays rays = camera(makePose({0, 0, 0.6}, {0.1, turn, 0.4}));
    EXPECT_GT(compare({placed(both, Pose::Identity())}, rays, {}), 500) << turn;
  }
}

TEST(DepthScene, EndsAtTheFarthestDepthItself) {
  const PinholeRays rays{{8, 8, 60.0, 3.5, 3.5}, Pose::Identity()};
  const std::vector<RayTarget> wall = {placed(geometry::boxMesh({2, 9, 9}), makePose({3, 0, 0}))};
  EXPECT_EQ(compare(wall, rays, {2, -1, 0}), 64);
  EXPECT_EQ(compare(wall, rays, {std::nextafter(2, 0), -1, 0}), 0);
  EXPECT_EQ(compare({}, rays, {}), 0);
}

/** Depths of one band of 16 rows and 24 columns by one set of kernels. */
std::vector<double> drawnBy(const kernels::Kernels& kernels, const CollisionGeometry& geometry, const kernels::PixelRays& rays) {
  constexpr int ROWS = 16, COLUMNS = 24;
  std::vector<double> numbers(4 * ROWS * COLUMNS, NO_DEPTH);
  std::vector<std::uint8_t> axes(2 * ROWS * COLUMNS);
  std::vector<kernels::DepthTile> tiles(ROWS * COLUMNS / (kernels::TILE * kernels::TILE), {NO_DEPTH, 0});
  double* const d = numbers.data();
  const int n = ROWS * COLUMNS;
  const kernels::PixelMesh mesh{reinterpret_cast<const unsigned char*>(geometry.bvh().nodes().data()), geometry.bvh().order().data(),
                                geometry.mesh().elements.data()->data(), geometry.mesh().vertices.data()->data(), 1e-12};
  kernels.drawDepths(mesh, rays, {0, ROWS, COLUMNS, COLUMNS, d, tiles.data(), {d + n, d + 2 * n, d + 3 * n}, axes.data(), axes.data() + n});
  numbers.resize(n);
  return numbers;
}

TEST(DepthScene, EveryInstructionSetGivesTheSameBits) {
  geometry::RandomShapes random(13);
  for (int trial = 0; trial < 20; ++trial) {
    const RayTarget target = placed(geometry::icosphereMesh(0.8, 1 + trial % 4), Pose::Identity());
    const Pose X = makePose(random.point(1.2)) * random.pose(0);
    kernels::PixelRays rays{
        {1, 0, 0, 0, 1, 0, 0, 0, 1}, {}, {X.translation().x(), X.translation().y(), X.translation().z()}, 14, 11.5, 7.5, 0};
    for (int i = 0; i < 9; ++i) rays.R_CW[i] = X.linear()(i / 3, i % 3);
    const std::vector<double> expected = drawnBy(*kernels::availableKernels().front(), *target.geometry, rays);
    for (const kernels::Kernels* kernels : kernels::availableKernels())
      EXPECT_EQ(drawnBy(*kernels, *target.geometry, rays), expected) << kernels->name << ", trial " << trial;
  }
}

}  // namespace
}  // namespace blem_sim::contact
