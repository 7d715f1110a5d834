// Region where features may lie that have a contact with a leaf's.
#pragma once

#include "neighbourhood/leaf_features.h"

namespace blem_sim::contact {

/** @param leaf its faces, edges and vertices, with their shapes */
kernels::LeafRegion leafRegion(const MeshSide& side, const geometry::Bvh::Node& node, const LeafFeatures& leaf);

}  // namespace blem_sim::contact
