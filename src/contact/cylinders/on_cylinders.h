// Contacts of cylinders, from those of the meshes that stand for them.
#pragma once

#include "blem_sim/contact/narrow_phase.h"

namespace blem_sim::contact {

/**
 * Moves contacts from the mesh of a cylinder onto the cylinder itself, so that it rolls without bumps.
 * On a plane, the vertex of each rim that is nearest to the rim's lowest point stands for that point; beside the others, which a circle
 * does not have, contacts fade as the cylinder leans over. Vertices and edges of the other surface meet the mantle and the rims where they
 * are. On moving bodies that point has the rim's name, and names of vertices count from it, so that contacts keep theirs while a cylinder
 * rolls.
 * @param range [m] largest gap; contacts beyond are dropped @param manifold of the pair: contacts in the world
 */
void moveOntoCylinders(const PlacedCollider& a, const PlacedCollider& b, double range, ContactManifold* manifold);

}  // namespace blem_sim::contact
