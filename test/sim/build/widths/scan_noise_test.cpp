// Noise of scans, told from their triangles.
#include "build/widths/scan_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "blem_sim/model/loaders.h"
#include "support/shared_data.h"

namespace blem_sim::sim {
namespace {

double noiseOf(const geometry::TriangleMesh& mesh) { return scanNoise(mesh, geometry::MeshTopology(mesh)); }

/** Every vertex moved along z, and by `sideways` [m] along x and y. */
geometry::TriangleMesh withNoise(geometry::TriangleMesh mesh, double noise, double sideways) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (Vector3& v : mesh.vertices) v += Vector3(sideways * normal(random), sideways * normal(random), noise * normal(random));
  return mesh;
}

TEST(ScanNoise, IsThatOfAPlane) {
  const geometry::TriangleMesh plane = geometry::gridMesh(1, 1, 100, 100);
  EXPECT_LT(noiseOf(plane), 1e-15);
  for (const double noise : {1e-4, 5e-4, 1e-3}) {
    EXPECT_NEAR(noiseOf(withNoise(plane, noise, 0)), noise, 0.05 * noise);
    EXPECT_NEAR(noiseOf(withNoise(plane, noise, 0.001)), noise, 0.08 * noise) << "points off their grid";
  }
  EXPECT_NEAR(noiseOf(withNoise(plane, 0.003, 0.001)), 0.003, 0.0009) << "a third of the edges: many are sharp";
}

TEST(ScanNoise, CurvedAndSharpSurfacesHaveHardlyAny) {
  EXPECT_LT(noiseOf(geometry::icosphereMesh(0.1, 4)), 0.0005 * 0.1);
  EXPECT_LT(noiseOf(geometry::icosphereMesh(0.1, 5)), 0.0002 * 0.1);
  geometry::TriangleMesh hills = geometry::gridMesh(1, 1, 100, 100);
  for (Vector3& v : hills.vertices) v.z() = 0.02 * std::sin(20 * v.x()) * std::cos(15 * v.y());
  EXPECT_LT(noiseOf(hills), 5e-5);
  EXPECT_NEAR(noiseOf(withNoise(hills, 0.001, 0)), 0.001, 0.00007);
}

TEST(ScanNoise, OfFewVerticesIsNotTold) {
  EXPECT_EQ(noiseOf(geometry::boxMesh({1, 1, 1})), 0);
  EXPECT_EQ(noiseOf(geometry::cylinderMesh(0.1, 0.2)), 0);
  EXPECT_EQ(noiseOf(withNoise(geometry::gridMesh(1, 1, 15, 15), 0.01, 0)), 0);
  EXPECT_EQ(noiseOf({}), 0);
}

// The virtual camera's noise is 0.0012 + 0.0019 (z - 0.4)^2 m at a depth of z; its frames were averaged for the one, not for the other.
TEST(ScanNoise, OfScansIsTheirCameras) {
  SKIP_WITHOUT_SHARED_DATA("scans/synthetic_kinect/chair_raw_60k.ply");
  const auto of = [](const std::string& file) { return noiseOf(*model::loadSurface(*sharedData(file)).mesh); };
  const double raw = of("scans/synthetic_kinect/chair_raw_60k.ply");
  EXPECT_GT(raw, 0.0012);
  EXPECT_LT(raw, 0.004);
  EXPECT_LT(of("scans/synthetic_kinect/chair_150k.ply"), 0.5 * raw);
}

}  // namespace
}  // namespace blem_sim::sim
