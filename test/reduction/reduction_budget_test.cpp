// Budgets hold over several manifolds, for every reduction.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <climits>

#include "reduction/contact_patches.h"

namespace blem_sim::reduction {
namespace {

class Budgets : public ::testing::TestWithParam<int> {
 protected:
  const Reduction& method() const { return reductionTable()[GetParam()]; }
};

int contactsOf(int model, const std::vector<contact::ContactManifold>& manifolds, const std::vector<int>& model_a,
               const std::vector<int>& model_b) {
  int count = 0;
  for (std::size_t m = 0; m < manifolds.size(); ++m) {
    if (model_a[m] == model || model_b[m] == model) count += static_cast<int>(manifolds[m].contacts.size());
  }
  return count;
}

// Models: 0 the static world, 1 a robot (k = 50), 2 and 3 objects (k = 20).
TEST_P(Budgets, HoldForRobotObjectsAndStaticWorld) {
  const std::vector<ContactBudget> budgets = {{INT_MAX}, {50}, {20}, {20}};
  const std::vector<int> model_a = {1, 1, 1, 1, 0, 2, 1, 0};
  const std::vector<int> model_b = {0, 0, 2, 0, 2, 3, 1, 3};
  std::vector<contact::ContactManifold> manifolds;
  for (int m = 0; m < 8; ++m) manifolds.push_back(manifoldOf(m, m + 1, noisyPatch(m == 3 ? 2 : 200 + 10 * m, 50 + m)));
  int before = 0, after = 0;
  for (const contact::ContactManifold& manifold : manifolds) before += static_cast<int>(manifold.contacts.size());
  ReductionMemory memory;
  const int left_out = reduceAll(manifolds, model_a, model_b, budgets, method(), &memory).contacts;
  for (const contact::ContactManifold& manifold : manifolds) {
    after += static_cast<int>(manifold.contacts.size());
    EXPECT_GE(manifold.contacts.size(), manifold.a == 3 ? 2u : 3u) << manifold.a;
  }
  EXPECT_EQ(left_out, before - after);
  if (method().reduce == reduceNone) {
    EXPECT_EQ(left_out, 0);
    return;
  }
  EXPECT_LE(contactsOf(1, manifolds, model_a, model_b), 50);
  EXPECT_LE(contactsOf(2, manifolds, model_a, model_b), 20);
  EXPECT_LE(contactsOf(3, manifolds, model_a, model_b), 20);
  EXPECT_GT(contactsOf(1, manifolds, model_a, model_b), 25);
}

TEST_P(Budgets, AreTheSameForAnyNumberOfThreads) {
  std::vector<contact::ContactManifold> manifolds[2];
  ReductionLoss loss[2];
  for (const int threads : {1, 3}) {
    std::vector<contact::ContactManifold>& of_run = manifolds[threads / 2];
    std::vector<int> model_a, model_b;
    for (int m = 0; m < 60; ++m) {
      of_run.push_back(manifoldOf(m, m + 1, noisyPatch(20 + m, 10 + m)));
      model_a.push_back(1 + m / 4);
      model_b.push_back(m % 3 ? 0 : 1 + m / 5);
    }
    ReductionMemory memory;
    const std::vector<ContactBudget> budgets(20, {30});
    tbb::task_arena(threads).execute([&] { loss[threads / 2] = reduceAll(of_run, model_a, model_b, budgets, method(), &memory); });
  }
  EXPECT_EQ(loss[0].contacts, loss[1].contacts);
  EXPECT_EQ(loss[0].wrench, loss[1].wrench);
  for (int m = 0; m < 60; ++m) {
    ASSERT_EQ(manifolds[0][m].contacts.size(), manifolds[1][m].contacts.size());
    for (std::size_t c = 0; c < manifolds[0][m].contacts.size(); ++c) {
      EXPECT_EQ(manifolds[0][m].contacts[c].id, manifolds[1][m].contacts[c].id);
      EXPECT_EQ(manifolds[0][m].contacts[c].point, manifolds[1][m].contacts[c].point);
    }
  }
}

TEST_P(Budgets, LeaveThreeOfEveryPairHoweverManyThereAre) {
  if (method().reduce == reduceNone) return;  // has no budget
  for (const int k : {3, 4, 20, 26}) {
    std::vector<contact::ContactManifold> manifolds;
    for (int m = 0; m < 9; ++m) manifolds.push_back(manifoldOf(0, m + 1, noisyPatch(m == 8 ? 2 : 5, 70 + m)));
    const std::vector<int> robot(9, 1), world(9, 0);
    ReductionMemory memory;
    const ReductionLoss loss = reduceAll(manifolds, robot, world, {{INT_MAX}, {k}}, method(), &memory);
    for (const contact::ContactManifold& manifold : manifolds) EXPECT_EQ(manifold.contacts.size(), manifold.b == 9 ? 2u : 3u);
    EXPECT_EQ(contactsOf(1, manifolds, robot, world), 26);
    EXPECT_EQ(loss.cut_pairs, 8);
  }
}

// A model whose own budget is a contact or two gets that per pair: a point on a point.
TEST_P(Budgets, AreOfAPairWhatAModelsOwnIs) {
  if (method().reduce == reduceNone) return;  // has no budget
  for (const int k : {1, 2}) {
    std::vector<contact::ContactManifold> manifolds = {manifoldOf(0, 1, noisyPatch(5, 70)), manifoldOf(0, 2, noisyPatch(5, 71))};
    ReductionMemory memory;
    reduceAll(manifolds, {1, 1}, {0, 0}, {{INT_MAX}, {k}}, method(), &memory);
    for (const contact::ContactManifold& manifold : manifolds) EXPECT_EQ(static_cast<int>(manifold.contacts.size()), k);
  }
}

/** Largest lack of the kept contacts' support function, as ReductionLoss::wrench bounds it, over directions of its own. */
double worstLack(const Contacts& all, const Contacts& kept) {
  Box box;
  for (const contact::Contact& contact : all) box.extend(contact.point);
  const double radius = 0.5 * box.diagonal().norm();
  Noise noise(5);
  double worst = 0;
  for (int d = 0; d < 4000; ++d) {
    Eigen::Matrix<double, 6, 1> w;
    for (int i = 0; i < 6; ++i) w[i] = noise() + noise() + noise();
    w.normalize();
    // Torques about the middle.
    const Vector3 b = w.tail<3>() / radius, a = w.head<3>() - b.cross(box.center());
    worst = std::max(worst, support(all, a, b) - support(kept, a, b));
  }
  return worst;
}

TEST_P(Budgets, SayByHowMuchWrenchesAreOff) {
  if (method().reduce == reduceNone) return;  // leaves nothing out
  for (const int k : {3, 6, 12, 30}) {
    for (const bool flat : {false, true}) {
      const Contacts all = flat ? flatPatch(200, {0, 0.6, 0.8}, {1, 2, 3}) : noisyPatch(200);
      std::vector<contact::ContactManifold> manifolds = {manifoldOf(0, 1, all)};
      ReductionMemory memory;
      const ReductionLoss loss = reduceAll(manifolds, {0}, {1}, {{k}, {INT_MAX}}, method(), &memory);
      const double worst = worstLack(all, manifolds[0].contacts);
      EXPECT_LE(worst, loss.wrench) << k << " " << flat;
      EXPECT_GT(worst, 0.7 * loss.wrench - 0.1) << k << " " << flat;
      // A reduction that goes on with the choice tells no larger loss.
      std::vector<contact::ContactManifold> again = {manifoldOf(0, 1, all)};
      const double told = reduceAll(again, {0}, {1}, {{k}, {INT_MAX}}, method(), &memory).wrench;
      EXPECT_LE(told, loss.wrench + 1e-6);
      EXPECT_LE(worstLack(all, again[0].contacts), told);
    }
  }
}

TEST_P(Budgets, SayNothingWhereNothingIsCut) {
  std::vector<contact::ContactManifold> manifolds = {manifoldOf(0, 1, noisyPatch(12)),
                                                     manifoldOf(0, 2, flatPatch(8, {0, 0, 1}, {0, 0, 0}))};
  ReductionMemory memory;
  const ReductionLoss loss = reduceAll(manifolds, {1, 1}, {0, 0}, {{INT_MAX}, {20}}, method(), &memory);
  EXPECT_EQ(loss.cut_pairs, 0);
  EXPECT_EQ(loss.wrench, 0);
}

TEST(HullBudget, GivesAllToThosePairsThatNeedLittle) {
  std::vector<contact::ContactManifold> manifolds = {manifoldOf(0, 1, flatPatch(300, {0, 0, 1}, {0, 0, 0})),
                                                     manifoldOf(0, 2, noisyPatch(90, 6))};
  const std::size_t corners = reducedBy(*findReduction("hull"), manifolds[0].contacts, 40).size();
  ASSERT_LT(corners, 20u);
  ReductionMemory memory;
  reduceAll(manifolds, {1, 1}, {0, 0}, {{INT_MAX}, {40}}, *findReduction("hull"), &memory);
  EXPECT_EQ(manifolds[0].contacts.size(), corners);
  EXPECT_EQ(manifolds[1].contacts.size(), 40 - corners);
}

// A plate stands on its four corners while something round lies on it: with three of them it would tip over the missing one.
TEST(HullBudget, LeavesFourCornersBesideCrowds) {
  Contacts corners;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      corners.push_back(makeContact({x, y, 0}, Vector3::UnitZ(), 0, static_cast<std::uint64_t>(corners.size())));
  std::vector<contact::ContactManifold> manifolds = {manifoldOf(0, 1, noisyPatch(90, 6)), manifoldOf(0, 2, noisyPatch(80, 7)),
                                                     manifoldOf(0, 3, corners)};
  ReductionMemory memory;
  reduceAll(manifolds, {1, 1, 1}, {0, 0, 0}, {{INT_MAX}, {20}}, *findReduction("hull"), &memory);
  EXPECT_EQ(manifolds[2].contacts.size(), 4u);
  EXPECT_EQ(manifolds[0].contacts.size(), 8u);
  EXPECT_EQ(manifolds[1].contacts.size(), 8u);
}

TEST_P(Budgets, ChoosePiercedContactsLast) {
  if (method().reduce == reduceNone) return;  // has no choice
  Contacts contacts = noisyPatch(300);
  for (int i = 0; i < 150; ++i) {
    contacts[i].pierced = true;
    contacts[i].depth = 0.05;
  }
  std::vector<contact::ContactManifold> manifolds = {manifoldOf(0, 1, contacts)};
  ReductionMemory memory;
  reduceAll(manifolds, {0}, {1}, {{20}, {INT_MAX}}, method(), &memory);
  ASSERT_FALSE(manifolds[0].contacts.empty());
  EXPECT_LE(manifolds[0].contacts.size(), 20u);
  EXPECT_GE(std::count_if(manifolds[0].contacts.begin(), manifolds[0].contacts.end(), [](const contact::Contact& c) { return !c.pierced; }),
            15);

  for (contact::Contact& c : contacts) c.pierced = true;
  manifolds = {manifoldOf(0, 1, contacts)};
  reduceAll(manifolds, {0}, {1}, {{20}, {INT_MAX}}, method(), &memory);
  EXPECT_FALSE(manifolds[0].contacts.empty());
}

INSTANTIATE_TEST_SUITE_P(Table, Budgets, ::testing::Range(0, static_cast<int>(reductionTable().size())),
                         [](const auto& info) { return std::string(reductionTable()[info.param].name); });

}  // namespace
}  // namespace blem_sim::reduction
