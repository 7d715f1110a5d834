// Finds the contacts of two meshes: every pair of simplices, each asked once by the two elements that own them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "element_shape.h"
#include "mesh_pair.h"

namespace blem_sim {

/** An edge of one mesh passes through a face of the other. */
struct Crossing {
  bool edge_of_moving;
  int edge;
  int face;  ///< element
};

/** What a search works in; kept between searches for its memory only. */
struct SearchBuffers {
  static constexpr std::uint32_t NO_LEAF = 0xFFFFFFFF;
  struct FixedLeaf {
    std::uint32_t leaf = NO_LEAF;
    std::vector<ElementShape> shapes;
  };

  std::vector<std::pair<std::uint32_t, std::uint32_t>> leaf_pairs;
  std::vector<ElementShape> moving_leaf;
  Vector3 leaf_lower, leaf_upper;                                     ///< box of moving_leaf
  std::vector<FixedLeaf> fixed_leaves = std::vector<FixedLeaf>(512);  ///< leaf i, if it is held, at i modulo their number
  std::vector<FeatureContact> contacts;
  std::vector<Crossing> crossings;
};

/** Fills buffers->contacts and ->crossings (both cleared first). Complete: see narrow_phase.h. */
void searchSimplexPairs(const MeshPair& pair, SearchBuffers* buffers);

}  // namespace blem_sim
