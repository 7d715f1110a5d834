// Features kept of leaves.
#include <gtest/gtest.h>

#include <algorithm>

#include "contact/contact_shapes.h"
#include "neighbourhood/leaf_features.h"

namespace blem_sim::contact {
namespace {

// A search that comes to more leaves than are kept must still know which it has seen: else one vertex would count as two. A leaf in a
// place is not taken for the one that had it before.
TEST(LeafMemory, OneSearchLosesNoLeaf) {
  const Collider plane = makeCollider(geometry::gridMesh(1, 1, 300, 300), 0);
  const MeshSide side(*plane.geometry);
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t i = 0; i < side.bvh.nodes().size(); ++i)
    if (side.bvh.nodes()[i].isLeaf()) leaves.push_back(i);
  ASSERT_GT(leaves.size(), 17000u);
  LeafMemory memory;
  SurroundingsMemory surroundings;
  for (const std::uint64_t search : {1, 2}) {
    for (const std::uint32_t leaf : leaves) {
      KeptLeaf& found = memory.find(side, leaf, search);
      ASSERT_EQ(found.index.moving, KeptLeaf::NO_INDEX);
      found.index.moving = leaf;
      memory.describe(side, leaf, &surroundings, &found);
    }
    for (const std::uint32_t leaf : leaves) {
      KeptLeaf& found = memory.find(side, leaf, search);
      ASSERT_EQ(found.index.moving, leaf);
      ASSERT_EQ(memory.describe(side, leaf, &surroundings, &found).faces.names[0],
                static_cast<int>(side.bvh.order()[side.bvh.nodes()[leaf].first]));
    }
    std::reverse(leaves.begin(), leaves.end());
  }
}

}  // namespace
}  // namespace blem_sim::contact
