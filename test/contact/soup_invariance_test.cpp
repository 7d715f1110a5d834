// A mesh and its broken copies, cleaned and mended, push the same: the cones of wrenches of their reduced contacts agree.
#include <gtest/gtest.h>

#include <array>
#include <tuple>

#include "blem_sim/geometry/mesh_mending.h"
#include "blem_sim/reduction/reduction.h"
#include "contact/contact_shapes.h"
#include "contact/stl_soup.h"
#include "geometry/ply_soup.h"
#include "support/broken_meshes.h"
#include "support/sanitizers.h"
#include "support/shared_data.h"

namespace blem_sim::contact {
namespace {

constexpr double WIDTH = 0.0025;  // [m]
constexpr double CRACKS = 1e-5;   // [m] in each coordinate
constexpr double MOTION = 1e-5;   // [m]
constexpr double OVERLAP = 1e-3;  // [m] of the layers
constexpr double ARM = 0.05;      // [m] that makes turns shifts
constexpr int BUDGET = 50;
constexpr double SAME = 1e-9;         // [m] of support, where the surface is the same
constexpr double SOUPS_ALIKE = 1e-4;  // [m] where it was cracked

Collider loaded(const geometry::TriangleMesh& soup) {
  geometry::MeshReport report;
  const geometry::TriangleMesh cleaned = geometry::cleanMesh(soup, &report, geometry::RepeatedIndices::ARE_DEGENERATE);
  return makeCollider(geometry::mendMesh(cleaned, &report), WIDTH);
}

/**
 * Motions that the contacts forbid: the depth [m] of the deepest contact after each of some small motions of A, to first order. It is the
 * support function of the cone of wrenches, each contact's with its depth; contacts that others imply do not change it.
 */
std::vector<double> supports(const Collider& a, const Pose& X_WA, const Collider& b) {
  std::vector<Contact> contacts = contactsOf(a, X_WA, b, Pose::Identity(), 0.001).contacts;
  reduction::reduceHull(contacts, BUDGET);
  geometry::RandomShapes random(9);
  std::vector<double> supports;
  for (int i = 0; i < 40; ++i) {
    const Vector3 shift = random.point(MOTION), turn = random.point(MOTION) / ARM;
    double deepest = 0;
    for (const Contact& c : contacts)
      deepest = std::max(deepest, c.depth - (shift + turn.cross(c.point - X_WA.translation())).dot(c.normal_BA));
    supports.push_back(deepest);
  }
  return supports;
}

struct SoupScene {
  const char* name;
  geometry::TriangleMesh mesh;
  Collider below;
  double height;  ///< [m] to start from
};

using Copy = std::tuple<std::string, geometry::TriangleMesh, double>;

std::vector<Copy> copiesOf(const geometry::TriangleMesh& mesh) {
  geometry::RandomShapes random(10);
  return {{"subdivided", geometry::subdivided(mesh, 1), SAME},
          {"shuffled", shuffledCopy(mesh, random), SAME},
          {"rewound", rewoundCopy(mesh, random), SAME},
          {"doubled", doubledCopy(mesh), SAME},
          {"unwelded", crackedCopy(mesh, 0, random), SAME},
          {"T-junctions", tJunctionCopy(mesh), SAME},
          {"cracked", crackedCopy(mesh, CRACKS, random), SOUPS_ALIKE},
          {"cracked with T-junctions", crackedCopy(tJunctionCopy(mesh), CRACKS, random), SOUPS_ALIKE}};
}

void expectSameSupports(const SoupScene& scene, const std::vector<Copy>& copies, int poses) {
  const Collider whole = loaded(scene.mesh);
  std::vector<Collider> broken;
  for (const Copy& copy : copies) broken.push_back(loaded(std::get<1>(copy)));
  std::vector<double> worst(copies.size(), 0);
  geometry::RandomShapes random(11);
  for (int pose = 0; pose < samples(poses); ++pose) {
    const double tilt = std::array<double, 4>{0, 0.003, 0.1, 3}[pose % 4];
    Pose X_WA = makePose({random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), scene.height},
                         {random.uniform(-tilt, tilt), random.uniform(-tilt, tilt), random.uniform(-3, 3)});
    X_WA = lowered(whole, X_WA, scene.below, OVERLAP);
    const std::vector<double> expected = supports(whole, X_WA, scene.below);
    for (std::size_t i = 0; i < copies.size(); ++i) {
      const std::vector<double> found = supports(broken[i], X_WA, scene.below);
      for (std::size_t k = 0; k < found.size(); ++k) worst[i] = std::max(worst[i], std::abs(found[k] - expected[k]));
    }
  }
  for (std::size_t i = 0; i < copies.size(); ++i) {
    const auto& [name, mesh, tolerance] = copies[i];
    std::printf("%-14s %-26s support differs by up to %.3g um\n", scene.name, name.c_str(), 1e6 * worst[i]);
    EXPECT_LE(worst[i], tolerance) << scene.name << " " << name;
  }
}

geometry::TriangleMesh hills(double size, int cells, double height) {
  geometry::RandomShapes random(12);
  return hillMesh(random, size, cells, height);
}

const geometry::TriangleMesh SOUP_CUBE = geometry::boxMesh(Vector3::Constant(0.1));

TEST(SoupInvariance, CubeOnCubeAndHills) {
  expectSameSupports({"cube on cube", SOUP_CUBE, loaded(SOUP_CUBE), 0.2}, copiesOf(SOUP_CUBE), 200);
  expectSameSupports({"cube on hills", SOUP_CUBE, makeCollider(hills(0.6, 30, 0.002), 0), 0.2}, copiesOf(SOUP_CUBE), 200);
}

TEST(SoupInvariance, MugOnPlaneAndHills) {
  const geometry::TriangleMesh mug = geometry::cleanMesh(readStlSoup(BLEM_SIM_SOURCE_DIR "/meshes/shell_mug.stl"), nullptr);
  expectSameSupports({"mug on plane", mug, makeCollider(geometry::gridMesh(1, 1, 4, 4), 0), 0.2}, copiesOf(mug), 60);
  expectSameSupports({"mug on hills", mug, makeCollider(hills(0.6, 30, 0.002), 0), 0.2}, copiesOf(mug), 60);
}

TEST(SoupInvariance, FootOnHills) {
  const char* const FOOT = "robots/klampt/huboplus/meshes/Body_LAR_col_simple.stl";
  SKIP_WITHOUT_SHARED_DATA(FOOT);
  const geometry::TriangleMesh foot = geometry::cleanMesh(readStlSoup(*sharedData(FOOT)), nullptr);
  expectSameSupports({"foot on hills", foot, makeCollider(hills(1, 50, 0.002), 0), 0.25}, copiesOf(foot), 100);
}

TEST(SoupInvariance, PathologicalCubesOnHills) {
  SKIP_WITHOUT_SHARED_DATA("pathological");
  std::vector<Copy> copies;
  for (const char* name : {"cube_duplicate_faces", "cube_flipped", "cube_zero_area", "cube_nan"})
    copies.emplace_back(name, geometry::readPlySoup(*sharedData(std::string("pathological/") + name + ".ply")), SAME);
  expectSameSupports(
      {"cube on hills", geometry::readPlySoup(*sharedData("pathological/cube_flipped.ply")), makeCollider(hills(0.6, 30, 0.002), 0), 0.2},
      copies, 200);
}

}  // namespace
}  // namespace blem_sim::contact
