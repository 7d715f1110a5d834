// Rays from one point, and the trees they meet: plain numbers, the same for every instruction set.
#pragma once

#include <cstdint>

namespace blem_sim::contact::kernels {

constexpr int FAN = 8;  // rays of a fan
constexpr unsigned ALL_OF_FAN = (1u << FAN) - 1;
constexpr int DEEPEST_TREE = 64;               // edges from the root to the deepest leaf
constexpr double FAN_ROUNDING = 16 * 0x1p-52;  // of the place where a ray enters a box, relative to it

/** Rays from one point, side by side, in a tree's frame. Lengths along a ray are in units of its direction. */
struct FanRays {
  double origin[3];
  double directions[3][FAN];  ///< by coordinate, none zero
  double nearest;             ///< where all rays begin to count
};

/** Nodes of a geometry::Bvh, as they lie in memory. */
struct FanTree {
  const unsigned char* nodes;
  double wider;  ///< [m] by which boxes are widened
};

/** Takes the leaves of a tree. @param lanes bits of the rays that may meet the leaf's box */
struct FanVisitor {
  void (*visit)(void* self, std::uint32_t leaf, unsigned lanes);
  void* self;
};

/** Elements below a tree's leaves. */
struct FanMesh {
  FanTree tree;
  const std::uint32_t* order;
  const int* elements;     ///< three indices each
  const double* vertices;  ///< [m] three coordinates each
  int axis;                ///< longest coordinate of all rays' directions
};

/** First hits of a fan's rays. */
struct FanHits {
  double t[FAN];              ///< before a search: where the ray ends to count
  std::int64_t element[FAN];  ///< -1: none
};

}  // namespace blem_sim::contact::kernels
