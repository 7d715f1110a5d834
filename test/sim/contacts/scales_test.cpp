// Parts of a millimetre and of a decimetre in a room of a kilometre, at the origin and far from it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/simulation_scene.h"
#include "support/sanitizers.h"

namespace blem_sim::sim {
namespace {

constexpr double ROOM = 1024, KILOMETRE = 1000;  // [m]
constexpr double FAR_FILE = 5e6;                 // [m] where the coordinates of a file lie
constexpr double FRICTION = 0.5, SIDES_SLID = 20;

enum class Place { ORIGIN, WORLD_A_KILOMETRE_AWAY, FILE_FAR_AWAY };

EnvironmentConfig room(Place place) {
  const Vector3 file = place == Place::FILE_FAR_AWAY ? Vector3(FAR_FILE, -FAR_FILE, 0) : Vector3(0, 0, 0);
  geometry::TriangleMesh mesh = geometry::gridMesh(ROOM, ROOM, 1, 1);
  for (Vector3& v : mesh.vertices) v += file;
  EnvironmentConfig environment;
  environment.name = "room";
  environment.uri = meshFile("room" + std::to_string(static_cast<int>(place)), mesh);
  environment.X_WE = makePose(-file);
  return environment;
}

/** Where a cube comes to rest that starts along x at its resting height, in its sides. */
Vector3 restInSides(double side, double sides_slid, Place place) {
  const Vector3 offset = place == Place::WORLD_A_KILOMETRE_AWAY ? Vector3(KILOMETRE, -KILOMETRE, 0) : Vector3(0, 0, 0);
  SimulationConfig config;
  config.contact.boundary_width = BoundaryWidth::chosen();
  config.contact.surface.friction = FRICTION;
  // Times go with the root of lengths.
  config.time_step = 0.002 * std::sqrt(side);
  config.environments = {room(place)};
  config.environments[0].X_WE = makePose(offset) * config.environments[0].X_WE;
  const double width = std::min(config.time_step, 0.05 * side);
  config.objects = {box("cube", Vector3::Constant(side), 1000 * side * side * side, offset + Vector3(0, 0, 0.5 * side + width))};
  config.objects[0].linear_velocity.x() = std::sqrt(2 * FRICTION * G * sides_slid * side);
  Simulator simulator(config, model::UriResolver());
  // What slides that far stops within 1430 steps, whatever its size.
  for (int i = 0; i < (SANITIZED ? 2000 : 5000); ++i) simulator.step();
  EXPECT_LT(bodyOf(simulator, "cube").v_WCom.norm(), 1e-6 * std::sqrt(side)) << side;
  return (bodyOf(simulator, "cube").X_WB.translation() - offset) / side;
}

TEST(Scales, PartsRestAndSlideAlikeWhereverTheyAre) {
  for (const double side : {0.001, 0.1}) {
    for (const double slid : {0.0, SIDES_SLID}) {
      const Vector3 here = restInSides(side, slid, Place::ORIGIN);
      EXPECT_NEAR(here.x(), slid, 0.02 * slid) << side;
      EXPECT_NEAR(here.z(), 0.5 + std::min(0.002 / std::sqrt(side), 0.05), 1e-6) << side;
      for (const Place place : {Place::WORLD_A_KILOMETRE_AWAY, Place::FILE_FAR_AWAY})
        EXPECT_LT((restInSides(side, slid, place) - here).norm(), 1e-6 * std::max(1.0, slid))
            << side << " m, place " << static_cast<int>(place);
    }
  }
}

TEST(Scales, PartsOfTwoSizesSlideAlike) {
  const Vector3 small = restInSides(0.001, SIDES_SLID, Place::ORIGIN);
  // Both layers are a twentieth of the side.
  EXPECT_LT((restInSides(0.0016, SIDES_SLID, Place::ORIGIN) - small).norm(), 1e-6 * SIDES_SLID);
}

}  // namespace
}  // namespace blem_sim::sim
