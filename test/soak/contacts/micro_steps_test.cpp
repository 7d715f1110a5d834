// A thousand micro-steps of 1 um on rough ground.
#include <gtest/gtest.h>

#include "contact/micro_steps.h"
#include "contact/stl_soup.h"
#include "soak/figures.h"
#include "support/shared_data.h"

namespace blem_sim {
namespace {

void expectSmooth(const contact::Scene& scene, double overlap) {
  const contact::Walk w = contact::walk(scene, overlap, soakShort() ? 1 : 4, 1000);
  const std::string name = scene.name;
  figure(name + ": orphans among " + std::to_string(w.steps) + " steps", w.orphans, "");
  figure(name + ": deepest orphan", 1e6 * w.deepest_orphan, "um");
  figure(name + ": springs change by", w.rate, "rigid shifts");
  figure(name + ": wrench support changes by", w.support, "rigid shifts");
  EXPECT_LE(w.support, 2);
}

contact::Collider shellMug() {
  return contact::makeCollider(geometry::cleanMesh(contact::readStlSoup(BLEM_SIM_SOURCE_DIR "/meshes/shell_mug.stl"), nullptr), contact::R);
}

TEST(SoakMicroSteps, MugOnFractalTerrain) {
  SKIP_WITHOUT_SHARED_DATA("meshes/klampt/terrain_fractal_terrain_1.stl");
  geometry::TriangleMesh terrain =
      geometry::cleanMesh(contact::readStlSoup(*sharedData("meshes/klampt/terrain_fractal_terrain_1.stl")), nullptr);
  // Cells of 15 mm instead of 15 cm: as large as the mug's foot is wide.
  const Vector3 middle = terrain.bounds().center();
  for (Vector3& v : terrain.vertices) v = 0.1 * (v - middle);
  const contact::Collider mug = shellMug(), ground = contact::makeCollider(terrain, 0);
  for (const double overlap : {1e-3, 1e-5}) expectSmooth({"mug on fractal terrain", mug, ground, 0.2, 0.3}, overlap);
}

TEST(SoakMicroSteps, CubeOnNoisyPlane) {
  geometry::RandomShapes random(5);
  const contact::Collider cube = contact::makeCollider(geometry::boxMesh(Vector3::Constant(0.1)), contact::R),
                          ground = contact::makeCollider(contact::hillMesh(random, 0.15, 40, 0.0005), 0);
  for (const double overlap : {1e-3, 1e-5}) expectSmooth({"cube on noisy plane", cube, ground, 0.06, 0.01}, overlap);
}

}  // namespace
}  // namespace blem_sim
