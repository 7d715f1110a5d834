// Colours and forces as pictures of a world show them: markers in rviz, view_world.
#pragma once

#include <vector>

#include "blem_sim/geometry/types.h"
#include "blem_sim/sim/simulator.h"

namespace blem_sim::sim {

/** Red, green and blue, 0 to 1. */
struct Colour {
  float r = 0, g = 0, b = 0;
};

/** Colour of a contact: green at no depth, yellow where the boundary layers are used up, red beyond and where bare meshes cross. */
Colour contactColour(const ContactReport& contact);

/** Pale colours for environments, brighter ones for objects, by turns; steel for robots. @param model index into Simulator::models() */
Colour modelColour(ModelKind kind, int model);

/** Upwards in the world, unit, as gravity has it [m/s^2]; z without gravity. */
Vector3 upwards(const Vector3& gravity);

/** @param share of b, 0 to 1 */
Colour mixed(const Colour& a, const Colour& b, double share);

/**
 * Colours that tell the height of a cloud's points, one each: from blue over green to yellow, the lowest and the highest twentieth alike.
 * @param points [m] @param up unit, in the points' frame
 */
std::vector<Colour> coloursByHeight(const std::vector<Vector3>& points, const Vector3& up);

/** Force of a contact [N] on the side that can move (A, if both can), world axes. */
Vector3 forceOnMovingSide(const ContactReport& contact);

/** Weight [N] of everything that moves; without gravity as at 1 m/s^2. */
double movingWeight(const Simulator& simulator);

}  // namespace blem_sim::sim
