// Edges around one vertex, side by side: plain numbers, the same for every instruction set.
#pragma once

#include <cstdint>

#include "kernels/records.h"

namespace blem_sim::contact::kernels {

constexpr int DIRECTION_BLOCK = 8;
/** Number of blocks that hold so many edges. */
constexpr int directionBlocks(int edges) { return (edges + DIRECTION_BLOCK - 1) / DIRECTION_BLOCK; }

/** Unit directions of some edges from the vertex; zero behind the last. */
struct alignas(64) EdgeDirections {
  double x[DIRECTION_BLOCK], y[DIRECTION_BLOCK], z[DIRECTION_BLOCK];
  double near[DIRECTION_BLOCK];  ///< NEAR_SUCCESSOR; -1 of flat edges, whose contacts take nothing over
};

/** Whether edges at a vertex lead down, and one may have a successor. */
struct LeadingEdges {
  bool down;  ///< some edge leads down, by a larger part (sine) than CONE_SLACK
  bool near;  ///< one of them, not flat, may have a contact near, with an edge square to `aside`: a successor is to be looked for
};

/** A vertex of some pair that leaves a face over one of its sides. */
struct LeavingSide {
  std::uint32_t pair;
  std::uint16_t side;
  bool is_above;                ///< the vertex is over the face, not under it
  std::uint32_t first, blocks;  ///< blocks of the vertex's EdgeDirections: the first, and their number
};

/** Vertices that leave faces over their sides. */
struct LeavingRun {
  const Candidate* pairs;
  const LeavingSide* sides;  ///< each of one of the pairs
  std::uint32_t count;       ///< of sides
};

}  // namespace blem_sim::contact::kernels
