// What is kept of leaves.
#include <gtest/gtest.h>

#include "contact_shapes.h"
#include "leaf_features.h"

namespace blem_sim {
namespace {

// A search that comes to more leaves than are kept must still know which it has seen: else one vertex would count as two.
TEST(LeafMemory, OneSearchLosesNoLeaf) {
  const Collider plane = makeCollider(gridMesh(1, 1, 300, 300), 0);
  const MeshSide side(*plane.geometry);
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t i = 0; i < side.bvh.nodes().size(); ++i)
    if (side.bvh.nodes()[i].isLeaf()) leaves.push_back(i);
  ASSERT_GT(leaves.size(), 17000u);
  LeafMemory memory;
  for (const std::uint64_t search : {1, 2}) {
    for (const std::uint32_t leaf : leaves) {
      KeptLeaf& found = memory.find(side, leaf, search);
      ASSERT_EQ(found.index[1], KeptLeaf::NO_INDEX);
      found.index[1] = leaf;
    }
    for (const std::uint32_t leaf : leaves) ASSERT_EQ(memory.find(side, leaf, search).index[1], leaf);
  }
}

}  // namespace
}  // namespace blem_sim
