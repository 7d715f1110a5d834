#include "kept/fading_records.h"

#include "kernels/vectors.h"

namespace blem_sim::contact {

FadingRecords::Directions FadingRecords::addDirections(const EdgesAtVertex& edges) {
  const Directions added{static_cast<std::uint32_t>(directions_.size()), static_cast<std::uint32_t>(edges.block_count)};
  directions_.insert(directions_.end(), edges.blocks, edges.blocks + edges.block_count);
  return added;
}

std::uint32_t FadingRecords::addShape(const MeshSide& side, int face, const PlaneReach& reach) {
  if (corners_.empty()) {
    corners_.reserve(FIRST_SHAPES);
    reaches_.reserve(FIRST_SHAPES);
  }
  kernels::FaceCorners& corners = corners_.emplace_back();
  for (int k = 0; k < 3; ++k) corners.of[k] = vec4(side.mesh.vertices[side.mesh.elements[face][k]], 0);
  reaches_.push_back(reach);
  return static_cast<std::uint32_t>(corners_.size()) - 1;
}

void FadingRecords::clear() {
  at_vertices_.clear();
  of_faces_.clear();
  directions_.clear();
  corners_.clear();
  reaches_.clear();
}

}  // namespace blem_sim::contact
