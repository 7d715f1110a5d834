// A choice among equals is gone on with while it is good; it is state.
#include <gtest/gtest.h>

#include <climits>
#include <cmath>

#include "blem_sim/contact/reduction.h"
#include "geometry/random_shapes.h"

namespace blem_sim {
namespace {

constexpr int CORNERS = 72;

/** The rim of a mug's foot, its depths trembling by some nanometres. */
ContactManifold rim(RandomShapes& random, double tremble) {
  ContactManifold manifold;
  manifold.a = 3;
  manifold.b = 7;
  for (int i = 0; i < CORNERS; ++i) {
    Contact contact;
    const double angle = 2 * M_PI * i / CORNERS;
    contact.point = {0.03 * std::cos(angle), 0.03 * std::sin(angle), 0};
    contact.normal_BA = Vector3::UnitZ();
    contact.depth = 1e-5 + random.uniform(-tremble, tremble);
    contact.id = 100 + i;
    manifold.contacts.push_back(contact);
  }
  return manifold;
}

ContactIds reduced(ContactManifold manifold, int k, ReductionMemory* memory) {
  std::vector<ContactManifold> manifolds = {std::move(manifold)};
  reduceManifolds(manifolds, {0}, {1}, {{k}, {INT_MAX}}, *findReduction("hull"), memory);
  ContactIds ids;
  for (const Contact& c : manifolds[0].contacts) ids.push_back(c.id);
  return ids;
}

TEST(ReductionMemory, KeepsItsChoiceAmongEquals) {
  RandomShapes random(4);
  ReductionMemory memory;
  const ContactIds first = reduced(rim(random, 1e-8), 20, &memory);
  ASSERT_EQ(first.size(), 20u);
  int forgetful = 0;
  for (int step = 0; step < 50; ++step) {
    const ContactManifold now = rim(random, 1e-8);
    EXPECT_EQ(reduced(now, 20, &memory), first) << step;
    ReductionMemory nothing;
    forgetful += reduced(now, 20, &nothing) != first;
  }
  EXPECT_GT(forgetful, 0);  // else there is nothing to remember
}

TEST(ReductionMemory, GivesUpAChoiceThatLacksMuch) {
  RandomShapes random(4);
  ReductionMemory memory;
  ContactManifold half = rim(random, 0);
  half.contacts.resize(CORNERS / 2);
  reduced(half, 20, &memory);
  // All of them now: what was chosen spans one half.
  ReductionMemory nothing;
  const ContactManifold whole = rim(random, 0);
  EXPECT_EQ(reduced(whole, 20, &memory), reduced(whole, 20, &nothing));
}

TEST(ReductionMemory, GivesUpAChoiceWithoutTheDeepest) {
  RandomShapes random(4);
  ReductionMemory memory;
  ContactManifold manifold = rim(random, 0);
  const ContactIds first = reduced(manifold, 20, &memory);
  for (Contact& c : manifold.contacts) {
    if (std::find(first.begin(), first.end(), c.id) != first.end()) continue;
    c.depth += 1e-4;
    const ContactIds now = reduced(manifold, 20, &memory);
    EXPECT_NE(std::find(now.begin(), now.end(), c.id), now.end());
    break;
  }
}

TEST(ReductionMemory, IsSavedAndReadBack) {
  RandomShapes random(4);
  ReductionMemory memory, copy;
  const ContactIds ids = reduced(rim(random, 1e-8), 20, &memory);
  std::vector<std::uint64_t> words = {42};
  memory.append(&words);
  const std::uint64_t* cursor = words.data() + 1;
  ASSERT_TRUE(copy.read(&cursor, words.data() + words.size()));
  EXPECT_EQ(cursor, words.data() + words.size());
  EXPECT_EQ(copy.of(rim(random, 0)), ids);
  words.pop_back();
  cursor = words.data() + 1;
  EXPECT_FALSE(copy.read(&cursor, words.data() + words.size()));
}

double totalWeight(std::vector<Contact> contacts) {
  weighSprings(contacts);
  double total = 0;
  for (const Contact& c : contacts) total += c.weight;
  return total;
}

TEST(SpringWeights, CountFullyUpToTheCornersOfARectangle) {
  RandomShapes random(4);
  for (int pose = 0; pose < 20; ++pose) {
    const Pose X = random.pose(1);
    std::vector<Contact> contacts(4);
    for (int i = 0; i < 4; ++i) {
      contacts[i].point = X * Vector3(i % 2 ? 0.05 : -0.05, i / 2 ? 0.02 : -0.02, 0);
      contacts[i].normal_BA = X.linear() * Vector3::UnitZ();
      contacts[i].depth = 1e-3;
    }
    for (int count = 1; count <= 4; ++count) {
      std::vector<Contact> some(contacts.begin(), contacts.begin() + count);
      weighSprings(some);
      for (const Contact& c : some) EXPECT_EQ(c.weight, 1) << count;
    }
  }
}

TEST(SpringWeights, HoldWhateverTheTessellation) {
  RandomShapes random(4);
  std::vector<Contact> contacts = rim(random, 0).contacts, doubled = contacts;
  doubled.insert(doubled.end(), contacts.begin(), contacts.end());
  std::vector<Contact> coarse;
  for (int i = 0; i < CORNERS; i += 3) coarse.push_back(contacts[i]);
  EXPECT_NEAR(totalWeight(contacts), 5, 0.1);
  EXPECT_NEAR(totalWeight(doubled), totalWeight(contacts), 1e-9);
  EXPECT_NEAR(totalWeight(coarse), totalWeight(contacts), 0.1);
}

TEST(SpringWeights, OfSidesOfACornerAreTheirOwn) {
  std::vector<Contact> contacts;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 4; ++i) {
      Contact contact;
      contact.point = Vector3::Constant(0.05);
      contact.point[axis] = 0;
      contact.point[(axis + 1) % 3] += i % 2 ? 0.05 : -0.04;
      contact.point[(axis + 2) % 3] += i / 2 ? 0.05 : -0.04;
      contact.normal_BA = Vector3::Unit(axis);
      contact.depth = 1e-4;
      contacts.push_back(contact);
    }
  }
  weighSprings(contacts);
  for (const Contact& c : contacts) EXPECT_EQ(c.weight, 1);
}

}  // namespace
}  // namespace blem_sim
