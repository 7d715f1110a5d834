// What is kept of leaves.
#include <gtest/gtest.h>

#include "contact_shapes.h"
#include "leaf_features.h"

namespace blem_sim {
namespace {

// A search that comes to more leaves than are kept must still know which it has seen: else one vertex would count as two.
TEST(LeafMemory, OneSearchLosesNoLeaf) {
  const Collider plane = makeCollider(gridMesh(1, 1, 200, 200), 0);
  const MeshSide side(*plane.geometry);
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t i = 0; i < side.bvh.nodes().size(); ++i)
    if (side.bvh.nodes()[i].isLeaf()) leaves.push_back(i);
  ASSERT_GT(leaves.size(), 9000u);
  LeafMemory memory;
  for (const std::uint64_t search : {1, 2}) {
    for (const std::uint32_t leaf : leaves) {
      LeafFeatures& features = memory.standing(side, leaf, search);
      ASSERT_EQ(features.index, LeafFeatures::NO_INDEX);
      features.index = leaf;
    }
    for (const std::uint32_t leaf : leaves) ASSERT_EQ(memory.standing(side, leaf, search).index, leaf);
  }
}

}  // namespace
}  // namespace blem_sim
