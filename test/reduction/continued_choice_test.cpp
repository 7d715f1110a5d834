#include "choice/continued_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "choice/wrench_choice.h"
#include "reduction/contact_patches.h"

namespace blem_sim::reduction {
namespace {

/** A ring of contacts, some at an inner radius [m]; normals and depths [m] vary by so much. */
Contacts variedRing(Noise* noise, double inner, double tilt, double gap) {
  Contacts contacts;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2 * M_PI * i / 40, radius = i % 8 == 0 ? inner : 0.05;
    const Vector3 normal(tilt * (*noise)(), tilt * (*noise)(), 1);
    contacts.push_back(makeContact({radius * std::cos(angle), 0.7 * radius * std::sin(angle), 0}, normal, gap * (*noise)(), 7 * i % 41));
  }
  return contacts;
}

/** k of the contacts, among them the deepest. */
ContactIds someOf(const Contacts& contacts, int k, Noise* noise) {
  std::vector<int> order(contacts.size());
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i-- > 1;) std::swap(order[i], order[static_cast<std::size_t>((*noise)() * 0.5 * i + 0.5 * i)]);
  const auto deeper = [](const contact::Contact& a, const contact::Contact& b) { return a.depth < b.depth; };
  const int deepest = static_cast<int>(std::max_element(contacts.begin(), contacts.end(), deeper) - contacts.begin());
  std::swap(*std::find(order.begin(), order.end(), deepest), order[0]);
  ContactIds ids;
  for (int i = 0; i < k; ++i) ids.push_back(contacts[order[i]].id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::vector<int> sorted(std::vector<int> indices) {
  std::sort(indices.begin(), indices.end());
  return indices;
}

TEST(ContinuedChoice, GoesOnOnlyWhereTheChoiceByWrenchesDoes) {
  Noise noise(11);
  int sure = 0, unsure = 0;
  ChosenBefore room;
  WrenchChoice choice;
  for (int round = 0; round < 4000; ++round) {
    const double tilts[] = {0, 0.005, 0.1}, gaps[] = {0, 1e-5, 5e-4};
    const Contacts contacts = variedRing(&noise, round % 2 ? 0.049 : 0.03, tilts[round % 3], gaps[round / 3 % 3]);
    const int k = 12 + round % 28;
    const ContactIds before = someOf(contacts, k, &noise);
    std::vector<int> members(contacts.size()), went_on, chosen;
    std::iota(members.begin(), members.end(), 0);
    bool ready = true;
    const PatchScale scale(contacts, &ready);
    ASSERT_TRUE(ready);
    const ChoiceQuestion asked{contacts, members, scale, k, before};
    if (!surelyGoesOn(asked, &room, &went_on)) {
      ++unsure;
      continue;
    }
    ++sure;
    std::vector<int> candidates = members;
    choice.choose(asked, &candidates, &chosen);
    ASSERT_EQ(sorted(went_on), sorted(chosen)) << round;
  }
  EXPECT_GT(sure, 400);
  EXPECT_GT(unsure, 400);
}

TEST(ContinuedChoice, IsNotSureWithoutTheDeepestOrWithOthersThanK) {
  Noise noise(12);
  Contacts contacts = variedRing(&noise, 0.05, 0, 0);
  ContactIds before;
  for (int i = 0; i < 40; i += 2) before.push_back(contacts[i].id);
  std::sort(before.begin(), before.end());
  std::vector<int> members(contacts.size()), chosen;
  std::iota(members.begin(), members.end(), 0);
  const auto goes_on = [&](int k) {
    bool ready = true;
    const PatchScale scale(contacts, &ready);
    ChosenBefore room;
    return surelyGoesOn({contacts, members, scale, k, before}, &room, &chosen);
  };
  EXPECT_TRUE(goes_on(20));
  EXPECT_FALSE(goes_on(19));
  EXPECT_FALSE(goes_on(21));
  contacts[1].depth += 2 * DEEP_ENOUGH;
  EXPECT_FALSE(goes_on(20));
  contacts[2].depth += 2 * DEEP_ENOUGH;
  EXPECT_TRUE(goes_on(20));
  contacts[2].id = 100;
  EXPECT_FALSE(goes_on(20));
}

// Hulls leave out contacts that are deeper by some roundings. The choice read in front of its room then: it was another one from thread to
// thread.
TEST(WrenchChoice, WithoutTheDeepestOfAllTakesTheDeepestThatIsThere) {
  Noise noise(13);
  WrenchChoice used;
  for (int round = 0; round < 50; ++round) {
    Contacts contacts = variedRing(&noise, 0.05, 0.01, 1e-9);
    contacts[7].depth = 3e-8;
    contacts[20].depth = 1.5e-8;
    std::vector<int> members(contacts.size()), chosen, again;
    std::iota(members.begin(), members.end(), 0);
    members.erase(members.begin() + 7);
    bool ready = true;
    const PatchScale scale(contacts, &ready);
    const ChoiceQuestion asked{contacts, members, scale, 5, {}};
    std::vector<int> candidates = members;
    used.choose(asked, &candidates, &chosen);
    candidates = members;
    WrenchChoice().choose(asked, &candidates, &again);
    ASSERT_EQ(sorted(chosen), sorted(again)) << round;
    ASSERT_EQ(chosen.size(), 5u);
    EXPECT_NE(std::find(chosen.begin(), chosen.end(), 20), chosen.end());
  }
}

}  // namespace
}  // namespace blem_sim::reduction
