#include "merging/id_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <numeric>

#include "geometry/random_shapes.h"

namespace blem_sim::contact {
namespace {

TEST(IdOrder, IsThatOfIdsThenOfIndices) {
  geometry::RandomShapes random(41);
  IdOrder order;
  // Names of few features, of those of large meshes, equal ones, and any bits.
  for (const std::uint64_t mask :
       std::initializer_list<std::uint64_t>{0xC000000FC00000FFu, 0xC01FFFFFC01FFFFFu, 0x4000000000000001u, 0u, 0xFFFFFFFFFFFFFFFFu}) {
    SCOPED_TRACE(mask);
    for (const std::size_t count : {0, 1, 7, 33, 400, 5000}) {
      SCOPED_TRACE(count);
      std::vector<Contact> contacts(count);
      const std::uint64_t common = random.bits() & ~mask;
      for (Contact& contact : contacts) contact.id = common | (random.bits() & mask);
      std::vector<std::uint32_t> expected(count);
      std::iota(expected.begin(), expected.end(), 0u);
      std::stable_sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) { return contacts[a].id < contacts[b].id; });
      const std::vector<IdOrder::Entry>& entries = order.of(contacts.data(), count);
      ASSERT_EQ(entries.size(), count);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(entries[i].index, expected[i]);
        EXPECT_EQ(entries[i].id, contacts[expected[i]].id);
      }
    }
  }
}

}  // namespace
}  // namespace blem_sim::contact
