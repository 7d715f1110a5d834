// Scenes on which contact generation is timed: bodies that move along given paths close to others.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "blem_sim/contact/collider.h"

namespace blem_sim {

/** Moving colliders against one that stands. Their poses are functions of the step; nothing is simulated. */
struct ContactScene {
  std::string name;
  contact::Collider standing;
  std::vector<contact::Collider> moving;
  std::function<Pose(int collider, int step)> pose;  ///< in the standing one's frame
  Vector3 approach = -Vector3::UnitZ();              ///< unit, that frame: the way from the moving bodies to the standing one
};

/** Speed [m/s] of the moving bodies; every one oscillates by itself at 5 Hz. */
constexpr double SCENE_SPEED = 0.1;

/**
 * Hubo, 57 links, standing on a grid of 3 m x 3 m with noise of 0.5 mm from lowest to highest, raised under its hands; r 2.5 mm.
 * @param triangles of the grid, about @param points the grid's vertices alone, half as many. Null without the shared data.
 */
std::unique_ptr<ContactScene> huboOnTerrain(int triangles, bool points = false);
/** A cube of 12 triangles, 18.3 cm wide, on the same grid: some 5,200 pairs of triangles within reach on a million. */
std::unique_ptr<ContactScene> cubeOnTerrain(int triangles);
/** Hubo on such noise, 10 mm from vertex to vertex, on a terrain that grows outward with the triangles: the same contacts on each. */
std::unique_ptr<ContactScene> huboOnGrowingTerrain(int triangles);
/** A cube of 12 triangles, 10 cm wide, on the same, 7.5 mm from vertex to vertex. */
std::unique_ptr<ContactScene> cubeOnGrowingTerrain(int triangles);
/** A slab of 12 triangles on the same, as wide as it must be for about so many contacts. */
std::unique_ptr<ContactScene> slabOnTerrain(int contacts);
/** A mug of 22,300 triangles upright on a fractal terrain, split to about `triangles`. Null without the shared data. */
std::unique_ptr<ContactScene> mugOnFractalTerrain(int triangles);
/** Two such mugs side by side, 2 mm apart, r 5 mm in all. */
std::unique_ptr<ContactScene> mugBesideMug();

}  // namespace blem_sim
