// Bare meshes that cross.
#pragma once

#include "features/mesh_pair.h"

namespace blem_sim::contact {

/** An edge of one mesh passes through a face of the other. */
struct Crossing {
  Side edge_side;
  int edge;
  int face;  ///< element
};

/**
 * Whether the edge passes through the face. One that only touches it, or only grazes a border, has an ordinary contact.
 * Precondition: the edge's ends are on different sides of the face's plane, neither within TOUCH of it.
 */
bool crosses(const MeshPair& pair, const Crossing& crossing);

}  // namespace blem_sim::contact
