// Meshes from clouds, by each mesher: where their surfaces are, where holes stay, what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "blem_sim/model/loaders.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::model {
namespace {

using Mesher = CloudOptions::Mesher;

constexpr double SPACING = 0.01;
constexpr double SIDE = 0.5;
constexpr double HOLE = 0.1;  // radius, in the middle

std::string gridFile(const std::vector<Vector3>& points, int width, int height) {
  std::string text = "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + std::to_string(width) + "\nHEIGHT " +
                     std::to_string(height) + "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points.size()) + "\nDATA ascii\n";
  for (const Vector3& p : points) text += std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  return text;
}

/** A level square with a round hole, with noise of deviation `noise` [m], as rows of points; what was not measured is NaN. */
std::vector<Vector3> holedSquare(double noise) {
  std::mt19937 random(5);
  std::normal_distribution<double> height(0, 1);
  std::vector<Vector3> points;
  for (double x = -0.5 * SIDE; x < 0.5 * SIDE; x += SPACING)
    for (double y = -0.5 * SIDE; y < 0.5 * SIDE; y += SPACING) {
      const Vector3 p(x, y, noise * height(random));
      points.push_back(p.head<2>().norm() < HOLE ? Vector3(NAN, NAN, NAN) : p);
    }
  return points;
}

CloudOptions by(Mesher mesher) {
  CloudOptions options;
  options.as = CloudOptions::As::MESH;
  options.mesher = mesher;
  options.max_edge = 0.04;
  options.cell = 0.02;
  options.viewpoint = Vector3(0, 0, 2);
  return options;
}

class EveryMesher : public testing::TestWithParam<Mesher> {
 protected:
  LoadedSurface load(const std::vector<Vector3>& points, const CloudOptions& options) {
    const int columns = static_cast<int>(std::lround(std::sqrt(points.size())));
    return loadSurface(folder_.write("cloud.pcd", gridFile(points, columns, columns)), Vector3::Ones(), options);
  }

  TemporaryFolder folder_;
};

/** Distance of the nearest triangle's middle from a place beside z. */
double nearestMiddle(const geometry::TriangleMesh& mesh, double x, double y) {
  double nearest = INFINITY;
  for (const Vector3i& e : mesh.elements) {
    const Vector3 middle = (mesh.vertices[e[0]] + mesh.vertices[e[1]] + mesh.vertices[e[2]]) / 3;
    nearest = std::min(nearest, std::hypot(middle.x() - x, middle.y() - y));
  }
  return nearest;
}

TEST_P(EveryMesher, FollowsAPlaneAndKeepsItsHole) {
  const LoadedSurface surface = load(holedSquare(0), by(GetParam()));
  for (const Vector3& p : surface.mesh->vertices) EXPECT_LT(std::abs(p.z()), 0.1 * SPACING);
  EXPECT_GT(nearestMiddle(*surface.mesh, 0, 0), HOLE - 0.03);
  for (double at = HOLE + 0.02; at < 0.5 * SIDE - 2 * SPACING; at += SPACING) EXPECT_LT(nearestMiddle(*surface.mesh, at, 0), SPACING);
}

TEST_P(EveryMesher, StaysWithinNoise) {
  constexpr double NOISE = 0.001;
  const LoadedSurface surface = load(holedSquare(NOISE), by(GetParam()));
  double squares = 0;
  for (const Vector3& p : surface.mesh->vertices) squares += p.z() * p.z();
  EXPECT_LT(std::sqrt(squares / surface.mesh->vertices.size()), 1.5 * NOISE);
}

TEST_P(EveryMesher, IsTheSameEveryTime) {
  const std::vector<Vector3> points = holedSquare(0.001);
  const LoadedSurface one = load(points, by(GetParam())), other = load(points, by(GetParam()));
  EXPECT_EQ(one.mesh->vertices, other.mesh->vertices);
  EXPECT_EQ(one.mesh->elements, other.mesh->elements);
}

TEST_P(EveryMesher, MeshesFarAwayAsNear) {
  std::vector<Vector3> points = holedSquare(0);
  const LoadedSurface near = load(points, by(GetParam()));
  CloudOptions options = by(GetParam());
  const Vector3 far(1000, -2000, 500);
  for (Vector3& p : points) p += far;
  *options.viewpoint += far;
  const LoadedSurface there = load(points, options);
  EXPECT_NEAR(there.report.triangles, near.report.triangles, 0.01 * near.report.triangles);
  for (const Vector3& p : there.mesh->vertices) EXPECT_LT(std::abs(p.z() - far.z()), 0.2 * SPACING);
}

TEST_P(EveryMesher, RefusesTooFewPointsInOneLine) {
  EXPECT_TRUE(isOneLineWith(refusal([&] { load(std::vector<Vector3>(4, Vector3(NAN, 0, 0)), by(GetParam())); }), {"cloud.pcd", "mesher"}));
}

INSTANTIATE_TEST_SUITE_P(CloudMeshers, EveryMesher,
                         testing::Values(Mesher::ORGANIZED, Mesher::GREEDY_PROJECTION, Mesher::MARCHING_CUBES, Mesher::POISSON));

using CloudMeshers = EveryMesher;

TEST_F(CloudMeshers, OfAPixelGridIsCutWhereDepthJumps) {
  // Two level halves, seen from half a metre: the jump of 3 cm is shorter than max_edge.
  std::vector<Vector3> points;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) points.emplace_back(SPACING * i, SPACING * j, i < 10 ? 0.5 : 0.53);
  CloudOptions options = by(Mesher::AUTO);
  options.viewpoint.reset();
  EXPECT_EQ(load(points, options).report.triangles, 2 * 19 * 19);
  options.max_depth_jump = 0.05;
  EXPECT_EQ(load(points, options).report.triangles, 2 * 18 * 19);
}

TEST_F(CloudMeshers, FillHolesOnlyWhenAsked) {
  CloudOptions options = by(Mesher::POISSON);
  options.fill_holes = true;
  EXPECT_LT(nearestMiddle(*load(holedSquare(0), options).mesh, 0, 0), 0.03);
}

TEST_F(CloudMeshers, OfPoissonJoinPartsByThemselves) {
  std::vector<Vector3> points = holedSquare(0);
  const LoadedSurface alone = load(points, by(Mesher::POISSON));
  std::vector<Vector3> far = {{0, 0, 4e3}, {0.01, 0, 4e3}, {0, 0.01, 4e3}, {0.01, 0.01, 4e3}};
  for (Vector3& p : points) {
    if (p.allFinite() || far.empty()) continue;
    p = far.back();
    far.pop_back();
  }
  const LoadedSurface beside = load(points, by(Mesher::POISSON));
  ASSERT_GE(beside.mesh->vertices.size(), alone.mesh->vertices.size());
  for (std::size_t i = 0; i < alone.mesh->vertices.size(); ++i) EXPECT_EQ(beside.mesh->vertices[i], alone.mesh->vertices[i]) << i;
}

TEST_F(CloudMeshers, OfABoxKeepItsSides) {
  std::vector<Vector3> points;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 20; ++j)
      for (const double side : {-0.1, 0.1})
        for (int k = 0; k < 3; ++k) {
          Vector3 p(side, SPACING * (i - 10), SPACING * (j - 10));
          points.emplace_back(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
        }
  for (const Mesher mesher : {Mesher::MARCHING_CUBES, Mesher::POISSON}) {
    CloudOptions options = by(mesher);
    options.viewpoint = Vector3::Zero();
    const std::string file = folder_.write("box.pcd", gridFile(points, static_cast<int>(points.size()), 1));
    const LoadedSurface surface = loadSurface(file, Vector3::Ones(), options);
    for (const Vector3& p : surface.mesh->vertices) EXPECT_NEAR(p.cwiseAbs().maxCoeff(), 0.1, 0.5 * options.cell) << p.transpose();
  }
}

TEST_F(CloudMeshers, RefuseInOneLineWhatTheyCannotMake) {
  const auto fault = [&](const CloudOptions& options) { return refusal([&] { load(holedSquare(0), options); }); };
  for (const Mesher mesher : {Mesher::MARCHING_CUBES, Mesher::POISSON}) {
    CloudOptions options = by(mesher);
    options.cell = 1e-6;
    EXPECT_TRUE(isOneLineWith(fault(options), {"cloud.pcd", "cell", "larger"}));
    options = by(mesher);
    options.filters.resize(1);
    options.filters[0].size = 1e-3;
    options.viewpoint.reset();
    EXPECT_TRUE(isOneLineWith(fault(options), {"cloud.pcd", "viewpoint: [x, y, z]"}));
    options.viewpoint = Vector3(NAN, 0, 0);
    EXPECT_TRUE(isOneLineWith(fault(options), {"cloud.pcd", "viewpoint"}));
  }
  CloudOptions options = by(Mesher::MARCHING_CUBES);
  options.fill_holes = true;
  EXPECT_TRUE(isOneLineWith(fault(options), {"cloud.pcd", "fill_holes", "poisson"}));
  options = by(Mesher::ORGANIZED);
  options.filters.resize(1);
  options.filters[0].size = 1e-3;
  EXPECT_TRUE(isOneLineWith(fault(options), {"organized", "pixel grid", "another mesher"}));
  options = by(Mesher::ORGANIZED);
  options.max_depth_jump = 0;
  EXPECT_TRUE(isOneLineWith(fault(options), {"max_depth_jump"}));
}

}  // namespace
}  // namespace blem_sim::model
