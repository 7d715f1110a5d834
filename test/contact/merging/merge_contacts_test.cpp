#include "merging/merge_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "geometry/random_shapes.h"

namespace blem_sim::contact {
namespace {

Contact makeContact(std::uint64_t id, const Vector3& point, const Vector3& normal, double depth, bool pierced = false) {
  Contact contact;
  contact.id = id;
  contact.point = point;
  contact.normal_BA = normal;
  contact.depth = depth;
  contact.pierced = pierced;
  return contact;
}

const Vector3 UP = Vector3::UnitZ();

std::vector<Contact> merged(const std::vector<Contact>& contacts) {
  std::vector<Contact> out(contacts.size());
  ContactMerge merge;
  out.resize(merge.run(contacts.data(), contacts.size(), out.data()));
  return out;
}

TEST(MergeContacts, CoincidentOnesBecomeTheDeepestUnderTheSmallestId) {
  const std::vector<Contact> contacts =
      merged({makeContact(9, {0, 0, 0}, UP, 0.1), makeContact(4, {1e-7, 0, 0}, UP, 0.3), makeContact(7, {0, 1e-7, 0}, UP, 0.2),
              makeContact(5, {0, 0, 0}, Vector3::UnitX(), 0.1), makeContact(6, {1e-6, 0, 0}, UP, 0.1)});
  ASSERT_EQ(contacts.size(), 3u);
  EXPECT_EQ(contacts[0].id, 4u);
  EXPECT_EQ(contacts[0].depth, 0.3);
  EXPECT_EQ(contacts[1].id, 5u);
  EXPECT_EQ(contacts[2].id, 6u);
}

TEST(MergeContacts, OneIdIsOneContact) {
  const std::vector<Contact> contacts = merged({makeContact(3, {0, 0, 0}, UP, 0.1), makeContact(3, {1, 0, 0}, UP, 0.2),
                                                makeContact(8, {2, 0, 0}, UP, 0.2), makeContact(8, {2, 0, 0}, -UP, 0.1, true)});
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_EQ(contacts[0].depth, 0.2);
  EXPECT_TRUE(contacts[1].pierced);
}

TEST(MergeContacts, AreSortedById) {
  geometry::RandomShapes random(5);
  for (const int count : {7, 400}) {
    std::vector<Contact> contacts;
    std::vector<std::uint64_t> ids;
    for (int i = 0; i < count; ++i) {
      // Names differ in few bits of their features, and in all.
      ids.push_back(i % 2 == 0 ? random.bits() : random.bits() & 0x80000007000000FFu);
      contacts.push_back(makeContact(ids.back(), {0.01 * i, 0, 0}, UP, 0.1));
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    contacts = merged(contacts);
    ASSERT_EQ(contacts.size(), ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(contacts[i].id, ids[i]);
  }
}

TEST(MergeContacts, OrderDoesNotMatter) {
  geometry::RandomShapes random(3);
  std::vector<Contact> contacts;
  for (int i = 0; i < 400; ++i) {
    contacts.push_back(makeContact(random.integer(0, 250), random.gridPoint(3) + random.point(1e-8), Vector3::Unit(random.integer(0, 2)),
                                   random.uniform(0, 1)));
  }
  std::vector<Contact> reversed(contacts.rbegin(), contacts.rend());
  contacts = merged(contacts);
  reversed = merged(reversed);
  ASSERT_EQ(contacts.size(), reversed.size());
  EXPECT_LE(contacts.size(), 64u * 3);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    EXPECT_EQ(contacts[i].id, reversed[i].id);
    EXPECT_EQ(contacts[i].point, reversed[i].point);
    EXPECT_EQ(contacts[i].depth, reversed[i].depth);
  }
}

}  // namespace
}  // namespace blem_sim::contact
