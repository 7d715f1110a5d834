// Stiffness of a patch does not depend on the number and places of its contacts, as tessellations give them.
#include <gtest/gtest.h>

#include <algorithm>

#include "reduction/contact_patches.h"

namespace blem_sim::reduction {
namespace {

void weigh(std::vector<contact::Contact>& contacts) {
  ReductionWorkspace workspace;
  weighSprings(contacts, &workspace);
}

double totalWeight(std::vector<contact::Contact> contacts) {
  weigh(contacts);
  double total = 0;
  for (const contact::Contact& c : contacts) total += c.weight;
  return total;
}

TEST(SpringWeights, CountFullyUpToTheCornersOfARectangle) {
  geometry::RandomShapes random(4);
  for (int pose = 0; pose < 2000; ++pose) {
    const Pose X = random.pose(1);
    const double size = pose % 2 ? 1 : 100;  // large ones share no direction
    std::vector<contact::Contact> contacts(4);
    for (int i = 0; i < 4; ++i) {
      contacts[i].point = X * (size * Vector3(i % 2 ? 0.05 : -0.05, i / 2 ? 0.02 : -0.02, 0));
      contacts[i].normal_BA = X.linear() * Vector3::UnitZ();
      contacts[i].depth = 1e-3;
    }
    for (int count = 1; count <= 4; ++count) {
      std::vector<contact::Contact> some(contacts.begin(), contacts.begin() + count);
      weigh(some);
      for (const contact::Contact& c : some) ASSERT_EQ(c.weight, 1) << count << ", pose " << pose;
    }
  }
}

TEST(SpringWeights, HoldWhateverTheTessellation) {
  geometry::RandomShapes random(4);
  std::vector<contact::Contact> contacts = rim(random, 0).contacts, doubled = contacts;
  doubled.insert(doubled.end(), contacts.begin(), contacts.end());
  std::vector<contact::Contact> coarse;
  for (int i = 0; i < RIM_CORNERS; i += 3) coarse.push_back(contacts[i]);
  EXPECT_NEAR(totalWeight(contacts), 5, 0.1);
  EXPECT_NEAR(totalWeight(doubled), totalWeight(contacts), 1e-9);
  EXPECT_NEAR(totalWeight(coarse), totalWeight(contacts), 0.1);
}

/** Weight as spring_weights.cpp defines it, contact by contact and with the library's exponential. */
double weightByDefinition(const std::vector<contact::Contact>& contacts, std::size_t i) {
  constexpr int DIRECTIONS = 96;
  double share = 0;
  for (int m = 0; m < DIRECTIONS; ++m) {
    const double z = (2.0 * m + 1) / DIRECTIONS - 1, r = std::sqrt(1 - z * z), angle = 2.39996322972865332 * m;
    const auto height = [&](const contact::Contact& c) {
      return (Vector3(r * std::cos(angle), r * std::sin(angle), z).dot(c.point) + 20 * c.depth) / 0.005;
    };
    double all = 0;
    for (const contact::Contact& c : contacts)
      all += std::max(0.0, 1 - (c.normal_BA - contacts[i].normal_BA).norm() / 0.5) * std::exp(height(c) - height(contacts[i]));
    share += 1 / all / DIRECTIONS;
  }
  return std::min(5 * share, 1.0);
}

TEST(SpringWeights, AreWhatTheirDefinitionSays) {
  std::vector<contact::Contact> contacts = noisyPatch(30);
  for (const contact::Contact& c : flatPatch(20, {0.2, 0.1, 1}, {0.03, 0, 0})) contacts.push_back(c);
  weigh(contacts);
  double least = 1;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const double expected = weightByDefinition(contacts, i);
    EXPECT_NEAR(contacts[i].weight, std::max(expected, 1e-6), 1e-12) << i;
    least = std::min(least, expected);
  }
  EXPECT_LT(least, 0.1);  // else they are hardly weighed
}

TEST(SpringWeights, OfSidesOfACornerAreTheirOwn) {
  std::vector<contact::Contact> contacts;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 4; ++i) {
      contact::Contact contact;
      contact.point = Vector3::Constant(0.05);
      contact.point[axis] = 0;
      contact.point[(axis + 1) % 3] += i % 2 ? 0.05 : -0.04;
      contact.point[(axis + 2) % 3] += i / 2 ? 0.05 : -0.04;
      contact.normal_BA = Vector3::Unit(axis);
      contact.depth = 1e-4;
      contacts.push_back(contact);
    }
  }
  weigh(contacts);
  for (const contact::Contact& c : contacts) EXPECT_EQ(c.weight, 1);
}

}  // namespace
}  // namespace blem_sim::reduction
