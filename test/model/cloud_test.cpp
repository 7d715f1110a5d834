// Filters and spacings of clouds.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "blem_sim/model/loaders.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::model {
namespace {

using Kind = CloudFilter::Kind;

constexpr double INF = std::numeric_limits<double>::infinity();

std::vector<Vector3> grid(double spacing, int count, const Vector3& corner = Vector3::Zero()) {
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) points.push_back(corner + spacing * Vector3(i, j, 0));
  return points;
}

CloudFilter voxels(double size) {
  CloudFilter filter;
  filter.size = size;
  return filter;
}

CloudFilter outliers(Kind kind, int neighbours, double factor, double radius) {
  CloudFilter filter;
  filter.kind = kind;
  filter.neighbours = neighbours;
  filter.factor = factor;
  filter.size = radius;
  return filter;
}

CloudFilter pass(int axis, double lower, double upper) {
  CloudFilter filter;
  filter.kind = Kind::PASS_THROUGH;
  filter.axis = axis;
  filter.lower = lower;
  filter.upper = upper;
  return filter;
}

std::vector<Vector3> left(std::vector<Vector3> points, const std::vector<CloudFilter>& filters) {
  std::vector<std::string> notes;
  std::vector<Vector3> result = filtered(std::move(points), filters, "test", &notes);
  EXPECT_GE(notes.size(), filters.size());
  return result;
}

TEST(PointSpacing, isThatOfAGridAndOfAScatter) {
  for (const double spacing : {0.002, 0.005, 0.01, 0.02}) EXPECT_NEAR(pointSpacing(grid(spacing, 60)), spacing, 1e-3 * spacing);
  EXPECT_NEAR(pointSpacing(grid(0.01, 60, {5e5, 4e6, 100})), 0.01, 1e-4);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, 1);
  std::vector<Vector3> scatter;
  for (int i = 0; i < 10000; ++i) scatter.emplace_back(place(random), place(random), 0);
  EXPECT_NEAR(pointSpacing(scatter), 0.011, 0.001);
  EXPECT_EQ(pointSpacing({Vector3::Zero()}), 0);
  EXPECT_NEAR(pointSpacing({Vector3::Zero(), Vector3(0, 0, 2)}), 2, 1e-6);
}

TEST(PointSpacing, givesARadiusBelowAThirdOfIt) {
  EXPECT_LT(pointRadius(0.01), 0.01 / 3);
  EXPECT_GT(pointRadius(0.01), 0.01 / 4);
  EXPECT_EQ(pointRadius(0), CloudOptions().point_radius);
  EXPECT_GT(pointRadius(1e-9), 0);
}

TEST(CloudFilters, voxelsKeepTheirMeans) {
  const std::vector<Vector3> few = left(grid(0.001, 100), {voxels(0.01)});
  EXPECT_NEAR(static_cast<double>(few.size()), 100, 21);
  EXPECT_EQ(few, left(grid(0.001, 100), {voxels(0.01)}));
  EXPECT_EQ(left({{0, 0, 0}, {0.001, 0, 0}, {NAN, 0, 0}}, {voxels(0.01)}).size(), 1u);
}

TEST(CloudFilters, outliersGo) {
  std::vector<Vector3> points = grid(0.01, 30);
  points.emplace_back(0.1, 0.1, 0.3);
  for (const CloudFilter& filter : {outliers(Kind::STATISTICAL_OUTLIERS, 8, 3, 0), outliers(Kind::RADIUS_OUTLIERS, 2, 0, 0.015)}) {
    const std::vector<Vector3> kept = left(points, {filter});
    EXPECT_GE(kept.size(), 890u);
    for (const Vector3& p : kept) EXPECT_LT(p.z(), 0.01);
  }
}

TEST(CloudFilters, passThroughIsExactAlsoFarAwayAndOpen) {
  for (const Vector3& corner : {Vector3(0, 0, 0), Vector3(5e5, 4e6, 0)}) {
    const double from = corner.x() + 0.0951;
    const std::vector<Vector3> kept = left(grid(0.01, 30, corner), {pass(0, from, INF), pass(1, -INF, corner.y() + 0.1951)});
    EXPECT_EQ(kept.size(), 20u * 20u);
    for (const Vector3& p : kept) EXPECT_GT(p.x(), from);
  }
}

TEST(CloudFilters, movingLeastSquaresTakeNoiseAway) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.001);
  std::vector<Vector3> points = grid(0.005, 60);
  for (Vector3& p : points) p.z() = 0.2 * p.x() * p.x() + noise(random);
  CloudFilter filter;
  filter.kind = Kind::MOVING_LEAST_SQUARES;
  filter.size = 0.04;
  const std::vector<Vector3> smooth = left(points, {filter});
  EXPECT_EQ(smooth.size(), points.size());
  EXPECT_EQ(smooth, left(points, {filter}));
  double squares = 0;
  for (const Vector3& p : smooth) squares += std::pow(p.z() - 0.2 * p.x() * p.x(), 2);
  EXPECT_LT(std::sqrt(squares / smooth.size()), 0.0003);
  filter.order = 6;
  EXPECT_TRUE(isOneLineWith(refusal([&] { left(points, {filter}); }), {"moving_least_squares", "order"}));
  filter.size = 0;
  EXPECT_TRUE(isOneLineWith(refusal([&] { left(points, {filter}); }), {"moving_least_squares", "radius"}));
}

TEST(CloudFilters, badOnesAreRefusedInOneLine) {
  const auto fault = [](const CloudFilter& filter) { return refusal([&] { left(grid(0.01, 30), {filter}); }); };
  EXPECT_TRUE(isOneLineWith(fault(voxels(0)), {"test", "voxel_grid", "above 0"}));
  EXPECT_TRUE(isOneLineWith(fault(voxels(NAN)), {"voxel_grid"}));
  EXPECT_TRUE(isOneLineWith(fault(voxels(1e-7)), {"voxel_grid", "2^31", "larger"}));
  EXPECT_TRUE(isOneLineWith(fault(outliers(Kind::STATISTICAL_OUTLIERS, 0, 2, 0)), {"statistical_outliers", "neighbours"}));
  EXPECT_TRUE(isOneLineWith(fault(outliers(Kind::STATISTICAL_OUTLIERS, 8, -1, 0)), {"statistical_outliers", "factor"}));
  EXPECT_TRUE(isOneLineWith(fault(outliers(Kind::RADIUS_OUTLIERS, 8, 0, 0)), {"radius_outliers", "radius"}));
  EXPECT_TRUE(isOneLineWith(fault(pass(2, 1, 0)), {"pass_through", "range"}));
}

TEST(CloudFilters, workOnFilesOfPointsAndOnTheirsAlone) {
  const TemporaryFolder folder;
  std::string ply = "ply\nformat ascii 1.0\nelement vertex 900\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  for (const Vector3& p : grid(0.01, 30)) ply += std::to_string(p.x()) + " " + std::to_string(p.y()) + " 0\n";
  CloudOptions options;
  options.auto_radius = true;
  options.filters = {pass(0, -1, 0.0951)};
  const LoadedSurface surface = loadSurface(folder.write("points.ply", ply), Vector3::Ones(), options);
  EXPECT_EQ(surface.report.points, 300);
  EXPECT_NEAR(surface.radius, 0.003, 1e-5);
  EXPECT_EQ(surface.report.boundary_width, surface.radius);
  const std::string faces = folder.write("faces.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_TRUE(isOneLineWith(refusal([&] { loadSurface(faces, Vector3::Ones(), options); }), {"faces.off", "filters", "as: points"}));
}

TEST(CloudSurface, ofNoPointIsRefused) {
  EXPECT_TRUE(isOneLineWith(refusal([] { cloudSurface(SensedCloud({}), {}, "live"); }), {"live", "no finite point"}));
  EXPECT_EQ(cloudSurface(SensedCloud({{0, 0, 0}, {NAN, 0, 0}}), {}, "live").report.points, 1);
}

}  // namespace
}  // namespace blem_sim::model
