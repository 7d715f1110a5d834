// Every reduction keeps the same promises; hull loses nothing on flat patches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <tuple>

#include "blem_sim/geometry/shortest_turn.h"
#include "hull_stages.h"
#include "reduction/contact_patches.h"
#include "reduction_room.h"

namespace blem_sim::reduction {
namespace {

// A ring around a handle: normals all around, which cancel in the mean.
Contacts ring(int count) {
  Contacts contacts;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    const Vector3 normal(std::cos(angle), std::sin(angle), 0);
    contacts.push_back(makeContact(-0.03 * normal, normal, 1e-3, i));
  }
  return contacts;
}

Contacts sphereCap(int count) {
  Noise noise(3);
  Contacts contacts;
  for (int i = 0; i < count; ++i) {
    const Vector3 p(0.01 * noise(), 0.01 * noise(), -std::sqrt(0.04 * 0.04 - 2e-4));
    const Vector3 normal = -p.normalized();
    contacts.push_back(makeContact(-0.04 * normal, normal, 2e-3 * normal.z() - 1.5e-3, i));
  }
  return contacts;
}

bool same(const contact::Contact& a, const contact::Contact& b) {
  return a.point == b.point && a.normal_BA == b.normal_BA && a.depth == b.depth && a.id == b.id && a.pierced == b.pierced;
}

bool sameAll(const Contacts& a, const Contacts& b) { return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), same); }

Contacts shuffled(Contacts contacts, unsigned seed) {
  std::mt19937 engine(seed);
  for (std::size_t i = contacts.size(); i > 1; --i) std::swap(contacts[i - 1], contacts[engine() % i]);
  return contacts;
}

struct InputCase {
  const char* name;
  std::function<Contacts()> make;
};

Contacts duplicates() {
  Contacts contacts;
  for (int i = 0; i < 200; ++i) contacts.push_back(makeContact({0.1, 0.2, 0.3}, {0, 0, 1}, 1e-3, 7));
  return contacts;
}

Contacts line() {
  Contacts contacts;
  for (int i = 0; i < 100; ++i) contacts.push_back(makeContact({0.001 * i, 0.0005 * i, 0}, {0, 0, 1}, 1e-3 + 1e-6 * i, i));
  return contacts;
}

Contacts opposite() {
  Contacts contacts = flatPatch(100, {0, 0, 1}, {0, 0, 0});
  for (contact::Contact c : flatPatch(100, {0, 0, -1}, {0, 0, 0.1}, 5)) {
    c.id += 1000;
    contacts.push_back(c);
  }
  return contacts;
}

// Contacts of many normals, and of places that tie in many directions.
Contacts roughGrid() {
  Contacts contacts;
  for (int i = 0; i < 30; ++i) {
    for (int j = 0; j < 30; ++j) {
      const Vector3 normal(0.004 * (i % 25 - 12), 0.004 * (j % 25 - 12), 1);
      contacts.push_back(makeContact({0.002 * i, 0.002 * j, 0}, normal, 1e-3, 30 * i + j));
    }
  }
  return contacts;
}

const InputCase INPUTS[] = {
    {"empty", [] { return Contacts(); }},
    {"one",
     [] {
       return flatPatch(1, {0, 0, 1}, {1, 2, 3});
     }},
    {"three",
     [] {
       return flatPatch(3, {1, 1, 1}, {1, 2, 3});
     }},
    {"flat",
     [] {
       return flatPatch(400, {0.3, -0.2, 1}, {0.5, 0.7, 0.1});
     }},
    {"noisy", [] { return noisyPatch(1500); }},
    {"few_noisy", [] { return noisyPatch(120); }},
    {"ring", [] { return ring(240); }},
    {"sphere", [] { return sphereCap(500); }},
    {"duplicates", duplicates},
    {"line", line},
    {"opposite", opposite},
    {"rough_grid", roughGrid},
};

class EveryReduction : public ::testing::TestWithParam<std::tuple<int, int>> {
 protected:
  const Reduction& method() const { return reductionTable()[std::get<0>(GetParam())]; }
  Contacts input() const { return INPUTS[std::get<1>(GetParam())].make(); }
  bool keepsAll() const { return method().reduce == reduceNone; }
};

TEST_P(EveryReduction, KeepsItsPromises) {
  const Contacts given = input();
  Box box;
  double deepest = -std::numeric_limits<double>::infinity();
  for (const contact::Contact& c : given) {
    box.extend(c.point);
    deepest = std::max(deepest, c.depth);
  }
  for (int k : {1, 2, 3, 7, 20, 50}) {
    const Contacts reduced = reducedBy(method(), given, k);
    SCOPED_TRACE(k);
    EXPECT_EQ(reduced.empty(), given.empty());
    if (keepsAll()) {
      EXPECT_EQ(reduced.size(), given.size());
    } else {
      EXPECT_LE(reduced.size(), static_cast<std::size_t>(k));
    }
    for (const contact::Contact& c : reduced) {
      EXPECT_NEAR(c.normal_BA.norm(), 1, 1e-12);
      EXPECT_TRUE(c.point.allFinite());
      EXPECT_LE(c.depth, deepest);
      EXPECT_TRUE((c.point.array() >= box.min().array()).all() && (c.point.array() <= box.max().array()).all());
    }
    EXPECT_TRUE(
        std::is_sorted(reduced.begin(), reduced.end(), [](const contact::Contact& a, const contact::Contact& b) { return a.id < b.id; }));
  }
}

TEST_P(EveryReduction, DoesNotDependOnTheOrderOfItsInput) {
  for (int k : {3, 20}) {
    const Contacts reference = reducedBy(method(), input(), k);
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Contacts other = reducedBy(method(), shuffled(input(), seed), k);
      EXPECT_TRUE(sameAll(reference, other)) << "k " << k << ", seed " << seed;
    }
  }
}

TEST_P(EveryReduction, ChangesNothingTheSecondTime) {
  const Contacts once = reducedBy(method(), input(), 20);
  const Contacts twice = reducedBy(method(), once, 20);
  EXPECT_TRUE(sameAll(once, twice));
}

TEST_P(EveryReduction, DropsContactsWithoutNumbersOrDirection) {
  Contacts contacts = input();
  const std::size_t sound = contacts.size();
  contact::Contact bad = makeContact({0, 0, 0}, {0, 0, 1}, 0, 5000);
  bad.depth = std::numeric_limits<double>::quiet_NaN();
  contacts.push_back(bad);
  bad = makeContact({0, 0, 0}, {0, 0, 1}, 0, 5001);
  bad.normal_BA.setZero();
  contacts.push_back(bad);
  bad = makeContact({std::numeric_limits<double>::infinity(), 0, 0}, {0, 0, 1}, 0, 5002);
  contacts.push_back(bad);
  const Contacts reduced = reducedBy(method(), contacts, 20);
  EXPECT_EQ(reduced.empty(), sound == 0);
  for (const contact::Contact& c : reduced) EXPECT_LT(c.id, 5000u);
}

std::string caseName(const ::testing::TestParamInfo<std::tuple<int, int>>& info) {
  return std::string(reductionTable()[std::get<0>(info.param)].name) + "_" + INPUTS[std::get<1>(info.param)].name;
}

INSTANTIATE_TEST_SUITE_P(Table, EveryReduction,
                         ::testing::Combine(::testing::Range(0, static_cast<int>(reductionTable().size())),
                                            ::testing::Range(0, static_cast<int>(std::size(INPUTS)))),
                         caseName);

TEST(Reduction, IsFoundByName) {
  for (const char* name : {"hull", "hierarchical", "kmeans", "none"}) {
    ASSERT_NE(findReduction(name), nullptr) << name;
    EXPECT_STREQ(findReduction(name)->name, name);
  }
  EXPECT_EQ(findReduction("Hull"), nullptr);
  EXPECT_EQ(findReduction(""), nullptr);
}

TEST(ReduceHull, KeepsExactlyTheCornersOfAGridOnAPlane) {
  Contacts contacts;
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) contacts.push_back(makeContact({0.005 * i, 0.005 * j, 0}, {0, 0, 1}, 1e-3, 21 * i + j));
  }
  reduceHull(contacts, 20);
  ASSERT_EQ(contacts.size(), 4u);
  EXPECT_EQ(contacts[0].id, 0u);
  EXPECT_EQ(contacts[1].id, 20u);
  EXPECT_EQ(contacts[2].id, 420u);
  EXPECT_EQ(contacts[3].id, 440u);
}

// Coincident vertices leave their contacts' places to rounding and to the merging of several: nothing of that may cost a corner.
TEST(ReduceHull, KeepsTheFourCornersHoweverTheSidesTremble) {
  Noise noise(12);
  for (int trial = 0; trial < 300; ++trial) {
    const Quaternion turn = geometry::shortestTurn(Vector3::UnitX(), Vector3(noise(), noise(), noise()));
    const double tremble = std::pow(10, -8.5 + noise());  // up to 32 nm
    Contacts contacts;
    for (int i = 0; i <= 4; ++i) {
      for (int j = 0; j <= 4; ++j) {
        if (i % 4 != 0 && j % 4 != 0) continue;
        const Vector3 p(0.025 * i + tremble * noise(), 0.025 * j + tremble * noise(), 1e-9 * noise());
        contacts.push_back(makeContact(trial % 2 ? p : Vector3(turn * p), trial % 2 ? Vector3::UnitZ() : Vector3(turn * Vector3::UnitZ()),
                                       1e-6 + 1e-6 * p.x(), 10 * i + j));
      }
    }
    reduceHull(contacts, 20);
    ASSERT_EQ(contacts.size(), 4u) << "trial " << trial << ", trembling by " << tremble;
    for (int corner = 0; corner < 4; ++corner) EXPECT_EQ(contacts[corner].id, 40u * (corner / 2) + 4u * (corner % 2));
  }
}

TEST(ReduceHull, LosesNoWrenchOnFlatPatches) {
  Noise noise(11);
  for (int trial = 0; trial < 40; ++trial) {
    const Vector3 normal(noise(), noise(), noise());
    Contacts all = flatPatch(300, normal.normalized(), {noise(), noise(), noise()}, 100 + trial);
    // A second plane of the same direction, 3 cm higher: the steps of a stair.
    Contacts upper = flatPatch(100, normal.normalized(), all[0].point + 0.03 * normal.normalized(), 200 + trial);
    for (contact::Contact& c : upper) c.id += 1000;
    all.insert(all.end(), upper.begin(), upper.end());
    Contacts reduced = all;
    reduceHull(reduced, 60);
    EXPECT_LT(reduced.size(), 60u);
    for (int d = 0; d < 500; ++d) {
      const Vector3 a(noise(), noise(), noise()), b(10 * noise(), 10 * noise(), 10 * noise());
      ASSERT_NEAR(support(reduced, a, b), support(all, a, b), 1e-12);
    }
  }
}

// Whether the kept contacts imply p's constraint: no affine function separates p from them in (x, y, depth).
bool isImplied(const contact::Contact& p, const Contacts& kept) {
  for (std::size_t i = 0; i < kept.size(); ++i) {
    for (std::size_t j = 0; j < kept.size(); ++j) {
      for (std::size_t l = 0; l < kept.size(); ++l) {
        Matrix3 m;
        m << kept[i].point.x(), kept[j].point.x(), kept[l].point.x(), kept[i].point.y(), kept[j].point.y(), kept[l].point.y(), 1, 1, 1;
        if (std::abs(m.determinant()) < 1e-14) continue;
        const Vector3 weights = m.inverse() * Vector3(p.point.x(), p.point.y(), 1);
        if (weights.minCoeff() < -1e-9) continue;
        if (weights.dot(Vector3(kept[i].depth, kept[j].depth, kept[l].depth)) >= p.depth - 1e-8) return true;
      }
    }
  }
  return false;
}

TEST(ReduceHull, KeepsWhatIsDeeperThanItsCornersInterpolate) {
  Contacts all = flatPatch(200, {0, 0, 1}, {0, 0, 0}, 21);
  for (contact::Contact& c : all) {
    const bool raised = std::abs(c.point.x()) < 0.02 && std::abs(c.point.y()) < 0.02;
    if (raised) c.depth += 5e-4;
  }
  Contacts reduced = all;
  reduceHull(reduced, 100);
  EXPECT_LT(reduced.size(), 50u);
  EXPECT_GT(std::count_if(reduced.begin(), reduced.end(), [](const contact::Contact& c) { return c.depth > 1.2e-3; }), 2);
  for (const contact::Contact& c : all) EXPECT_TRUE(isImplied(c, reduced)) << c.id;
}

TEST(ReduceHull, ImpliesEveryContactOfAPatchWithNoisyDepths) {
  Noise noise(22);
  Contacts all = flatPatch(300, {0, 0, 1}, {0, 0, 0}, 23);
  for (contact::Contact& c : all) c.depth += 1e-3 * noise();
  Contacts reduced = all;
  reduceHull(reduced, 150);
  EXPECT_LT(reduced.size(), 100u);
  for (const contact::Contact& c : all) EXPECT_TRUE(isImplied(c, reduced)) << c.id;
}

TEST(ReduceHull, KeepsContactsAsTheyAre) {
  const Contacts all = noisyPatch(800);
  Contacts reduced = all;
  reduceHull(reduced, 20);
  for (const contact::Contact& c : reduced) EXPECT_TRUE(same(c, all[c.id]));
}

TEST(ReduceHull, KeepsTheDeepestContact) {
  Contacts all = noisyPatch(800);
  all[400].depth = 2.45e-3 + 1e-4;
  for (int k : {1, 5, 20}) {
    Contacts reduced = all;
    reduceHull(reduced, k);
    EXPECT_EQ(std::count_if(reduced.begin(), reduced.end(), [](const contact::Contact& c) { return c.id == 400; }), 1) << k;
  }
}

TEST(ReduceHull, KeepsAllSidesOfARing) {
  Contacts all = ring(240);
  Contacts reduced = all;
  reduceHull(reduced, 12);
  for (int d = 0; d < 360; ++d) {
    const Vector3 a(std::cos(d * M_PI / 180), std::sin(d * M_PI / 180), 0);
    EXPECT_NEAR(support(reduced, a, Vector3::Zero()), support(all, a, Vector3::Zero()), 0.15);
  }
}

TEST(ReduceHull, SpansTheWrenchesOfANoisyPatch) {
  const Contacts all = noisyPatch(5000);
  for (const auto& [k, mean_limit] : {std::pair<int, double>{20, 0.04}, {50, 0.005}}) {
    Contacts reduced = all;
    reduceHull(reduced, k);
    const SupportError error = supportError(all, reduced);
    RecordProperty("mean_error_k" + std::to_string(k), std::to_string(error.mean));
    RecordProperty("max_error_k" + std::to_string(k), std::to_string(error.max));
    EXPECT_LT(error.mean, mean_limit) << "k " << k << ", max " << error.max;
    EXPECT_GE(error.mean, 0);
  }
}

// A tilted patch: contacts that do not touch yet count less by their gaps, and most of them nowhere at all.
TEST(ReduceHull, KeepsTheExtremesOfWhatHardlyTouches) {
  Noise noise(41);
  for (int trial = 0; trial < 30; ++trial) {
    Contacts all = noisyPatch(95, 300 + trial);
    const double slope = 2e-3 * std::pow(10, noise());
    for (contact::Contact& c : all) c.depth = slope * (c.point.x() - 0.03) + 1e-5 * noise();
    const auto reach = [](const Contacts& contacts, const Vector3& a, const Vector3& b) {
      double most = -std::numeric_limits<double>::infinity();
      for (const contact::Contact& c : contacts) most = std::max(most, support({c}, a, b) - 5000 * std::max(0.0, -c.depth));
      return most;
    };
    const Contacts reduced = reducedBy(*findReduction("hull"), all, 60);
    double sum = 0, level = 0;
    for (int d = 0; d < 300; ++d) {
      const Vector3 a(noise(), noise(), noise()), b(Vector3(noise(), noise(), noise()) / 0.05);
      sum += reach(all, a, b) - reach(reduced, a, b);
      level += std::abs(reach(all, a, b));
    }
    EXPECT_LT(sum, 0.03 * level) << trial;
  }
}

// A wheel with more corners than may be kept, and contacts inside of it: those are left out, and the choice is as good as any.
TEST(ReduceHull, SpansAPatchOfManyCorners) {
  Contacts all;
  for (int i = 0; i < 90; ++i) {
    const double angle = 2 * M_PI * i / 90, radius = i % 3 ? 0.05 : 0.03;
    all.push_back(makeContact({radius * std::cos(angle), radius * std::sin(angle), 0}, {0, 0, 1}, 1e-3, i));
  }
  const Contacts reduced = reducedBy(*findReduction("hull"), all, 20);
  EXPECT_EQ(reduced.size(), 20u);
  EXPECT_LT(supportError(all, reduced).mean, 0.01);
  HullRoom room;
  ThinnedContacts thinned;
  ASSERT_TRUE(thinToHulls(all, &room, &thinned));
  EXPECT_EQ(thinned.kept.size(), 60u);
}

// Vertices that coincide but for rounding are one corner, however many they are.
TEST(ReduceHull, KeepsFourCornersOfManyVerticesEach) {
  Noise noise(43);
  Contacts all;
  for (int i = 0; i < 80; ++i) {
    const Vector3 corner(0.05 * (i % 4 / 2), 0.05 * (i % 2), 0);
    all.push_back(makeContact(corner + 1e-8 * Vector3(noise(), noise(), 0), {0, 0, 1}, 1e-3, i));
  }
  EXPECT_EQ(reducedBy(*findReduction("hull"), all, 7).size(), 4u);
}

TEST(ReduceKmeans, AveragesWhatBelongsTogether) {
  Contacts contacts;
  for (int i = 0; i < 10; ++i) {
    contacts.push_back(makeContact({0.001 * i, 0, 0}, {0, 0, 1}, 1e-3, i));
    contacts.push_back(makeContact({1 + 0.001 * i, 0, 0}, {0, 0, 1}, 2e-3, 100 + i));
  }
  for (const char* name : {"kmeans", "hierarchical"}) {
    const Contacts reduced = reducedBy(*findReduction(name), contacts, 2);
    ASSERT_EQ(reduced.size(), 2u);
    EXPECT_NEAR(reduced[0].point.x(), 0.0045, 1e-12);
    EXPECT_NEAR(reduced[1].point.x(), 1.0045, 1e-12);
    EXPECT_NEAR(reduced[0].depth, 1e-3, 1e-12);
    EXPECT_NEAR(reduced[1].depth, 2e-3, 1e-12);
  }
}

}  // namespace
}  // namespace blem_sim::reduction
