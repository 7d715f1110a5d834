// A choice among equals is gone on with while it is good; it is state.
#include <gtest/gtest.h>

#include <algorithm>
#include <climits>

#include "reduction/contact_patches.h"

namespace blem_sim::reduction {
namespace {

ContactIds reduced(contact::ContactManifold manifold, int k, ReductionMemory* memory) {
  std::vector<contact::ContactManifold> manifolds = {std::move(manifold)};
  reduceAll(manifolds, {0}, {1}, {{k}, {INT_MAX}}, *findReduction("hull"), memory);
  ContactIds ids;
  for (const contact::Contact& c : manifolds[0].contacts) ids.push_back(c.id);
  return ids;
}

TEST(ReductionMemory, KeepsItsChoiceAmongEquals) {
  geometry::RandomShapes random(4);
  ReductionMemory memory;
  const ContactIds first = reduced(rim(random, 1e-8), 20, &memory);
  ASSERT_EQ(first.size(), 20u);
  int forgetful = 0;
  for (int step = 0; step < 50; ++step) {
    const contact::ContactManifold now = rim(random, 1e-8);
    EXPECT_EQ(reduced(now, 20, &memory), first) << step;
    ReductionMemory nothing;
    forgetful += reduced(now, 20, &nothing) != first;
  }
  EXPECT_GT(forgetful, 0);  // else there is nothing to remember
}

TEST(ReductionMemory, KeepsItsChoiceInACrowd) {
  Noise noise(8);
  ReductionMemory memory;
  const Contacts patch = noisyPatch(2000);
  const ContactIds first = reduced(manifoldOf(3, 7, patch), 20, &memory);
  for (int step = 0; step < 20; ++step) {
    Contacts now = patch;
    for (contact::Contact& c : now) {
      c.point += 1e-7 * Vector3(noise(), noise(), noise());
      c.depth += 1e-7 * noise();
    }
    EXPECT_EQ(reduced(manifoldOf(3, 7, now), 20, &memory), first) << step;
  }
}

TEST(ReductionMemory, GivesUpAChoiceThatLacksMuch) {
  geometry::RandomShapes random(4);
  ReductionMemory memory;
  contact::ContactManifold half = rim(random, 0);
  half.contacts.resize(RIM_CORNERS / 2);
  reduced(half, 20, &memory);
  // All contacts now: the choice spans one half of them.
  ReductionMemory nothing;
  const contact::ContactManifold whole = rim(random, 0);
  EXPECT_EQ(reduced(whole, 20, &memory), reduced(whole, 20, &nothing));
}

TEST(ReductionMemory, GivesUpAChoiceWithoutTheDeepest) {
  geometry::RandomShapes random(4);
  ReductionMemory memory;
  contact::ContactManifold manifold = rim(random, 0);
  const ContactIds first = reduced(manifold, 20, &memory);
  for (contact::Contact& c : manifold.contacts) {
    if (std::find(first.begin(), first.end(), c.id) != first.end()) continue;
    c.depth += 1e-4;
    const ContactIds now = reduced(manifold, 20, &memory);
    EXPECT_NE(std::find(now.begin(), now.end(), c.id), now.end());
    break;
  }
}

TEST(ReductionMemory, IsSavedAndReadBack) {
  geometry::RandomShapes random(4);
  ReductionMemory memory, copy;
  const ContactIds ids = reduced(rim(random, 1e-8), 20, &memory);
  geometry::StateContent saved{{}, {42}};
  geometry::StateWriter writer(&saved);
  memory.save(&writer);
  const std::vector<contact::Collider> colliders(10);
  geometry::StateReader reader(saved);
  ASSERT_EQ(reader.word(), 42u);
  copy.restore(colliders, &reader);
  EXPECT_EQ(reader.wordsLeft(), 0u);
  EXPECT_EQ(copy.of(rim(random, 0)), ids);
  saved.words.pop_back();
  geometry::StateReader cut(saved);
  cut.word();
  EXPECT_THROW(copy.restore(colliders, &cut), InputError);
}

}  // namespace
}  // namespace blem_sim::reduction
