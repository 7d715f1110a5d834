#include "merging/near_places.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "blem_sim/contact/contact_order.h"
#include "features/tolerances.h"
#include "geometry/random_shapes.h"

namespace blem_sim::contact {
namespace {

/** Five contacts at nearly each place of a grid, in a row across the slabs, the first and the last nearly as far apart as may be merged. */
std::vector<Contact> rows(geometry::RandomShapes* random, int count) {
  std::vector<Contact> contacts;
  for (int i = 0; i < count; ++i) {
    const Vector3 place = Vector3(0.01 * (i % 8), 0.01 * (i / 8 % 8), 0.01 * (i / 64) - 5) + random->point(1e-4);
    for (int k = 0; k < 5; ++k) {
      contacts.emplace_back();
      contacts.back().point = place + k * 0.2495 * MERGE_DISTANCE * UNCOMMON_DIRECTION;
    }
  }
  return contacts;
}

TEST(NearPlaces, AllWithinReachAreVisitedAndFewOthers) {
  geometry::RandomShapes random(17);
  NearPlaces places;
  for (const int count : {1, 7, 600}) {
    SCOPED_TRACE(count);
    const std::vector<Contact> contacts = rows(&random, count);
    places.begin(contacts.data(), contacts.size());
    std::size_t far_visits = 0;
    for (std::uint32_t i = 0; i < contacts.size(); ++i) {
      std::set<std::uint32_t> visited;
      EXPECT_FALSE(places.visitOrAdd(i, [&](std::uint32_t number, const Vector3& place) {
        EXPECT_TRUE(visited.insert(number).second);
        EXPECT_EQ(place, contacts[number].point);
        return false;
      }));
      for (std::uint32_t k = 0; k < i; ++k) {
        const bool is_near = (contacts[k].point - contacts[i].point).norm() <= MERGE_DISTANCE;
        EXPECT_TRUE(visited.count(k) == 1 || !is_near) << k << " and " << i;
        far_visits += visited.count(k) == 1 && !is_near;
      }
    }
    EXPECT_LT(far_visits, contacts.size());
  }
}

TEST(NearPlaces, OnesThatAreTakenAreNotAdded) {
  std::vector<Contact> contacts(3);
  for (Contact& contact : contacts) contact.point = Vector3(1, 2, 3);
  NearPlaces places;
  for (int round = 0; round < 2; ++round) {
    places.begin(contacts.data(), contacts.size());
    int visits = 0;
    const auto take = [&](std::uint32_t number, const Vector3&) {
      EXPECT_EQ(number, 0u);
      ++visits;
      return true;
    };
    EXPECT_FALSE(places.visitOrAdd(1, take));
    EXPECT_TRUE(places.visitOrAdd(0, take));
    EXPECT_TRUE(places.visitOrAdd(2, take));
    EXPECT_EQ(visits, 2);
  }
}

}  // namespace
}  // namespace blem_sim::contact
