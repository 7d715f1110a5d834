// Reports of a step from its parts, against sums made the plain way.
#include "part_reports.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <vector>

#include "numbers/random_numbers.h"

namespace blem_sim::sim {
namespace {

ContactReport contact(const Vector3& point, const Vector3& force, double depth = 0) {
  ContactReport report{1, 2, 0, 1, point, Vector3::UnitZ()};
  report.force = force;
  report.depth = depth;
  return report;
}

bool sameBits(const Vector3& a, const Vector3& b) { return std::memcmp(a.data(), b.data(), sizeof(double) * 3) == 0; }

TEST(PartReports, OnePartKeepsItsBits) {
  PartReports reports;
  reports.startStep(1);
  reports.startPart(1);
  const ContactReport given = contact({0.1, -0.3, 1e-17}, {-0.0, 1.0 / 3, 1e300}, 0.7);
  reports.addContact(5, given);
  reports.addJoints({{{1.0 / 3, 2, 3}, {4, 5, 1e-300}}}, {0.1});
  ASSERT_EQ(reports.contacts().size(), 1u);
  EXPECT_TRUE(sameBits(reports.contacts()[0].point, given.point));
  EXPECT_TRUE(sameBits(reports.contacts()[0].force, given.force));
  EXPECT_EQ(reports.contacts()[0].depth, 0.7);
  EXPECT_TRUE(sameBits(reports.jointWrenches()[0].force, {1.0 / 3, 2, 3}));
  EXPECT_TRUE(sameBits(reports.jointWrenches()[0].torque, {4, 5, 1e-300}));
  EXPECT_EQ(reports.efforts()[0], 0.1);
}

TEST(PartReports, ContactOfAnEarlierPartStaysWithItsImpulse) {
  PartReports reports;
  reports.startStep(0);
  reports.startPart(0.25);
  reports.addContact(5, contact({1, 2, 3}, {0, 0, 8}, 0.001));
  reports.startPart(0.75);
  reports.addContact(3, contact({4, 5, 6}, {0, 0, 4}, -0.001));
  ASSERT_EQ(reports.contacts().size(), 2u);
  EXPECT_EQ(reports.contacts()[0].force.z(), 2);
  EXPECT_EQ(reports.contacts()[0].point, Vector3(1, 2, 3));
  EXPECT_EQ(reports.contacts()[0].depth, 0.001);
  EXPECT_EQ(reports.contacts()[1].force.z(), 3);
}

TEST(PartReports, PointIsWhereTheImpulseWasAndNormalThatOfTheLargest) {
  PartReports reports;
  reports.startStep(0);
  const double fractions[] = {0.25, 0.25, 0.5}, pushes[] = {0, 12, 2}, depths[] = {0.003, 0.001, 0.002};
  const Vector3 normals[] = {Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()};
  for (int i = 0; i < 3; ++i) {
    ContactReport part = contact({double(i), 0, 0}, {0, 0, pushes[i]}, depths[i]);
    part.moment_a = {0, double(i), 0};
    part.normal_BA = normals[i];
    part.of_layer = 100 * depths[i];
    part.pierced = i == 1;
    reports.startPart(fractions[i]);
    reports.addContact(7, part);
  }
  ASSERT_EQ(reports.contacts().size(), 1u);
  const ContactReport& whole = reports.contacts()[0];
  EXPECT_DOUBLE_EQ(whole.force.z(), 4);
  EXPECT_DOUBLE_EQ(whole.point.x(), 0.75 * 1 + 0.25 * 2);
  EXPECT_DOUBLE_EQ(whole.moment_a.y(), 0.25 * 1 + 0.5 * 2);
  EXPECT_LT(whole.moment_b.norm(), 1e-15);
  EXPECT_EQ(whole.normal_BA, Vector3::UnitY());
  EXPECT_EQ(whole.depth, 0.003);
  EXPECT_DOUBLE_EQ(whole.of_layer, 0.3);
  EXPECT_TRUE(whole.pierced);
}

TEST(PartReports, NothingIsLeftOfTheStepBefore) {
  PartReports reports;
  for (int step = 0; step < 2; ++step) {
    reports.startStep(1);
    reports.startPart(0.5);
    reports.addContact(5, contact({0, 0, 0}, {0, 0, 2}));
    reports.startPart(0.5);
    reports.addContact(5, contact({0, 0, 0}, {0, 0, 4}));
    reports.addJoints({Wrench()}, {6});
    std::vector<ContactReport> taken(7);
    reports.takeContacts(&taken);
    ASSERT_EQ(taken.size(), 1u) << step;
    EXPECT_EQ(taken[0].force.z(), 3) << step;
    EXPECT_EQ(reports.efforts()[0], 3) << step;
  }
}

/** Mean force that a contact gives A in a step, and mean moments about the origin on A and B. */
struct Mean {
  Vector3 force = Vector3::Zero(), moment_a = Vector3::Zero(), moment_b = Vector3::Zero();
};

TEST(PartReports, ImpulsesAndMomentsOfRandomPartsAddUp) {
  RandomNumbers random(3);
  PartReports reports;
  for (int step = 0; step < 50; ++step) {
    std::map<std::uint64_t, Mean> expected;
    std::vector<std::uint64_t> order;
    reports.startStep(0);
    for (int part = 0; part < 4; ++part) {
      reports.startPart(0.25);
      for (std::uint64_t id = 0; id < 60; ++id) {
        if (random.next() % 2) continue;
        const std::uint64_t spread = id * 0x9e3779b97f4a7c15u;
        const Vector3 point = random.gaussianVector(), force = random.gaussianVector();
        ContactReport given = contact(point, force);
        given.moment_a = random.gaussianVector();
        given.moment_b = random.gaussianVector();
        reports.addContact(spread, given);
        if (!expected.count(spread)) order.push_back(spread);
        expected[spread].force += 0.25 * given.force;
        expected[spread].moment_a += 0.25 * (point.cross(force) + given.moment_a);
        expected[spread].moment_b += 0.25 * (point.cross(-force) + given.moment_b);
      }
    }
    ASSERT_EQ(reports.contacts().size(), order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const ContactReport& whole = reports.contacts()[i];
      ASSERT_LT((whole.force - expected[order[i]].force).norm(), 1e-14);
      ASSERT_LT((whole.point.cross(whole.force) + whole.moment_a - expected[order[i]].moment_a).norm(), 1e-13);
      ASSERT_LT((whole.point.cross(-whole.force) + whole.moment_b - expected[order[i]].moment_b).norm(), 1e-13);
    }
  }
}

}  // namespace
}  // namespace blem_sim::sim
