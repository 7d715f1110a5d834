// Micro-steps of 1 um: no contact deeper than a few of them comes or goes, and the forces of deep layers change as a rigid shift would.
#include <gtest/gtest.h>

#include "contact/micro_steps.h"
#include "contact/stl_soup.h"
#include "geometry/gridded_box.h"

namespace blem_sim::contact {
namespace {

Collider smoothCube() { return makeCollider(geometry::boxMesh(Vector3::Constant(0.1)), R); }
Collider pad() { return makeCollider(geometry::cleanMesh(geometry::griddedBox({0.02, 0.02, 0.004}, Vector3i(20, 20, 4)), nullptr), R); }
Collider shellMug() { return makeCollider(geometry::cleanMesh(readStlSoup(BLEM_SIM_SOURCE_DIR "/meshes/shell_mug.stl"), nullptr), R); }

TEST(Smoothness, CubeOnCube) {
  for (const double overlap : {1e-3, 1e-5}) {
    const Walk w = walk({"cube_cube", smoothCube(), smoothCube(), 0.12, 0.06}, overlap, 40, 100);
    EXPECT_EQ(w.orphans, 0);
    EXPECT_LE(w.rate, 1);
    EXPECT_LE(w.support, 2);
  }
}

TEST(Smoothness, FinePadOnCube) {
  for (const double overlap : {1e-3, 1e-5}) {
    const Walk w = walk({"pad_cube", pad(), smoothCube(), 0.065, 0.055}, overlap, 40, 100);
    EXPECT_EQ(w.orphans, 0);
    EXPECT_LE(w.rate, overlap < 1e-4 ? 1 : 20);
    EXPECT_LE(w.support, 2);
  }
}

TEST(Smoothness, BallOnFinePlane) {
  for (const double overlap : {1e-3, 1e-5}) {
    const Scene scene{"ball_plane", makeCollider(geometry::icosphereMesh(0.03, 3), R),
                      makeCollider(geometry::gridMesh(0.2, 0.2, 200, 200), 0), 0.04, 0.05};
    const Walk w = walk(scene, overlap, 16, 60);
    EXPECT_EQ(w.orphans, 0);
    EXPECT_LE(w.rate, 1);
    EXPECT_LE(w.support, 2);
  }
}

TEST(Smoothness, MugOnBoxAndMugOnMug) {
  const Collider mug = shellMug();
  const double height = -mug.geometry->bounds().min().z();
  for (const double overlap : {1e-3, 1e-5}) {
    for (const Walk& w : {walk({"mug_box", mug, smoothCube(), 0.06 + height, 0.06}, overlap, 8, 40),
                          walk({"mug_mug", mug, mug, 0.01 + 2 * height, 0.03}, overlap, 8, 40)}) {
      EXPECT_EQ(w.orphans, 0);
      EXPECT_LE(w.rate, overlap < 1e-4 ? 1 : 4);
      EXPECT_LE(w.support, 2);
    }
  }
}

/** Valleys everywhere: contacts leave faces and edges where nothing takes them over exactly. */
TEST(Smoothness, CubeOnNoise) {
  geometry::RandomShapes random(5);
  const Scene scene{"cube_noise", smoothCube(), makeCollider(hillMesh(random, 0.15, 40, 0.0002), 0), 0.06, 0.01};
  const Walk w = walk(scene, 1e-3, 12, 60);
  EXPECT_LE(w.orphans, 1);
  EXPECT_LE(w.support, 2);
}

/** A vertex that leaves a plane into a valley: its contact fades over half of its depth, at that rate and no faster. */
TEST(Smoothness, ContactFadesAcrossAConcaveEdge) {
  geometry::TriangleMesh valley;
  valley.vertices = {{0, -0.1, 0}, {0, 0.1, 0}, {-0.1, -0.1, 0}, {-0.1, 0.1, 0}, {0.1, -0.1, 0.02}, {0.1, 0.1, 0.02}};
  valley.elements = {{0, 1, 2}, {1, 3, 2}, {0, 4, 1}, {1, 4, 5}};
  const Collider floor = makeCollider(valley, R), point = makeCollider(octahedronMesh(0.02), R);
  const auto depthOnPlane = [&](double x) {
    double depth = 0;
    for (const Contact& c : contactsOf(point, makePose({x, 0.013, 0.024}), floor, Pose::Identity()).contacts) {
      // The lower tip on the level half.
      const bool level = (c.point - Vector3(std::min(x, 0.0), 0.013, 0.002)).norm() < 1e-3 && std::abs(c.normal_BA.x() - x / 0.004) < 0.05;
      if (level) depth = std::max(depth, c.depth);
    }
    return depth;
  };
  EXPECT_NEAR(depthOnPlane(-1e-6), 1e-3, 1e-9);
  EXPECT_NEAR(depthOnPlane(1e-6), 1e-3 - 2e-6, 1e-7);
  EXPECT_NEAR(depthOnPlane(1e-4), 1e-3 - 2e-4, 2e-6);
  EXPECT_NEAR(depthOnPlane(4.8e-4), 1e-3 - 9.6e-4, 3e-5);
  EXPECT_EQ(depthOnPlane(5.2e-4), 0);
}

}  // namespace
}  // namespace blem_sim::contact
