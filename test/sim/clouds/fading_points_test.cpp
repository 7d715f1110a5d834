#include "clouds/fading_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

namespace blem_sim::sim {
namespace {

constexpr double FOR_GOOD = std::numeric_limits<double>::infinity();

geometry::StateContent contentOf(const FadingPoints& fading) {
  geometry::StateContent content;
  geometry::StateWriter writer(&content);
  fading.save(&writer);
  return content;
}

std::vector<contact::Collider> threePoints() {
  std::vector<contact::Collider> colliders(2);
  for (contact::Collider& collider : colliders)
    collider.geometry = std::make_shared<const contact::CollisionGeometry>(std::make_shared<const geometry::TriangleMesh>(
        geometry::pointCloudMesh({Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(2, 0, 0)}, nullptr)));
  return colliders;
}

FadingPoints comingAndLeaving() {
  FadingPoints fading;
  fading.setUp(-Vector3::UnitZ());
  fading.addCrossing(0, 1);
  fading.add(1, 0.001, {{0, 0.0001}, {2, FOR_GOOD}});
  fading.add(0, -0.001, {{1, 0.002}});
  return fading;
}

/** A contact of a vertex of A, or of B, with a face. */
contact::Contact contactOf(std::uint64_t vertex, bool of_a) {
  const std::uint64_t face = std::uint64_t{2} << 30;
  contact::Contact contact;
  contact.point = Vector3::Zero();
  contact.normal_BA = Vector3::UnitZ();
  contact.depth = 0.003;
  contact.id = of_a ? vertex << 32 | face : face << 32 | vertex;
  return contact;
}

TEST(FadingPoints, MakeContactsLessDeepOnTheirOwnSide) {
  const FadingPoints fading = comingAndLeaving();
  const std::vector<contact::Collider> colliders = threePoints();
  contact::ContactManifold manifold;
  manifold.a = 0;
  manifold.b = 5;
  manifold.contacts = {contactOf(0, true), contactOf(1, true), contactOf(1, false)};
  fading.apply(colliders, &manifold);
  ASSERT_EQ(manifold.contacts.size(), 3u);
  EXPECT_EQ(manifold.contacts[0].depth, 0.003);
  EXPECT_DOUBLE_EQ(manifold.contacts[1].depth, 0.001);
  EXPECT_DOUBLE_EQ(manifold.contacts[1].point.z(), 0.001);  // the ball of A, above, is smaller from below
  EXPECT_EQ(manifold.contacts[2].depth, 0.003);
  manifold.a = -1;
  manifold.b = 1;
  manifold.contacts = {contactOf(0, false), contactOf(2, false)};
  fading.apply(colliders, &manifold);
  ASSERT_EQ(manifold.contacts.size(), 1u);
  EXPECT_DOUBLE_EQ(manifold.contacts[0].depth, 0.0029);
  EXPECT_DOUBLE_EQ(manifold.contacts[0].point.z(), -0.00005);
}

TEST(FadingPoints, OfATriangleSinkByTheirMean) {
  std::vector<contact::Collider> colliders(2);
  for (contact::Collider& collider : colliders)
    collider.geometry = std::make_shared<const contact::CollisionGeometry>(std::make_shared<const geometry::TriangleMesh>(
        geometry::TriangleMesh{{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)}, {Vector3i(0, 1, 2)}}));
  FadingPoints fading;
  fading.setUp(Vector3::UnitZ());
  fading.add(1, -0.001, {{1, 0.001}, {2, 0.002}});
  contact::ContactManifold manifold;
  manifold.a = 0;
  manifold.b = 1;
  manifold.contacts = {contactOf(0, true)};
  contact::Contact& contact = manifold.contacts[0];
  contact.point = Vector3(0.5, 0.25, -0.0015);  // of a face of B, as it has no layer
  contact.id = std::uint64_t{2} << 30;
  fading.apply(colliders, &manifold);
  EXPECT_NEAR(contact.depth, 0.003 - 0.5 * 0.001 - 0.25 * 0.002, 1e-12);
  EXPECT_NEAR(fading.sinkOf(colliders[1], 1, contact, false), 0.001, 1e-12);
  fading.forget(1);
  fading.add(1, -0.001, {{1, FOR_GOOD}});
  fading.apply(colliders, &manifold);
  EXPECT_TRUE(manifold.contacts.empty());
}

TEST(FadingPoints, PiercedContactsOfACrossingCountForNothing) {
  const std::vector<contact::Collider> colliders = threePoints();
  FadingPoints fading;
  fading.addCrossing(0, 1);
  contact::ContactManifold manifold;
  manifold.a = 0;
  for (const int other : {1, 2}) {
    manifold.b = other;
    manifold.pierced = true;
    manifold.contacts = {contactOf(0, true), contactOf(1, true)};
    manifold.contacts[1].pierced = true;
    fading.apply(colliders, &manifold);
    EXPECT_EQ(manifold.contacts.size(), other == 1 ? 1u : 2u);
    EXPECT_EQ(manifold.pierced, other != 1);
  }
}

TEST(FadingPoints, ComeAndLeaveAtTheirSpeed) {
  FadingPoints fading = comingAndLeaving();
  fading.advance(1, threePoints(), {});
  EXPECT_NEAR(fading.sinkOf(0, 1), 0.001, 1e-12);
  EXPECT_NEAR(fading.sinkOf(1, 0), 0.0011, 1e-12);
  EXPECT_EQ(fading.sinkOf(1, 2), FOR_GOOD);
  fading.advance(1.5, threePoints(), {});
  EXPECT_EQ(fading.sinkOf(0, 1), 0);
  fading.advance(100, threePoints(), {});
  EXPECT_EQ(fading.sinkOf(1, 0), FOR_GOOD);
  EXPECT_FALSE(fading.empty());
  fading.forget(1);
  EXPECT_TRUE(fading.empty());
}

TEST(FadingPoints, ThatComeWaitWhereTheyTouchUnlessTheyPushUpwards) {
  const std::vector<contact::Collider> colliders = threePoints();
  for (const double height : {1.0, -1.0, 0.0}) {
    FadingPoints fading;
    fading.setUp(height * Vector3::UnitZ());
    fading.add(1, -0.001, {{1, 0.002}, {2, 0.002}});
    contact::ContactManifold manifold;
    manifold.a = 0;
    manifold.b = 1;
    manifold.contacts = {contactOf(1, false)};  // pushes A along z
    fading.apply(colliders, &manifold);
    EXPECT_DOUBLE_EQ(manifold.contacts[0].depth, height > 0 ? 0.001 : 0);
    fading.advance(1, colliders, {manifold});
    EXPECT_DOUBLE_EQ(fading.sinkOf(1, 1), height > 0 ? 0.001 : 0.002);
    EXPECT_DOUBLE_EQ(fading.sinkOf(1, 2), 0.001);
    fading.addCrossing(0, 1);
    manifold.contacts = {contactOf(1, false)};
    fading.apply(colliders, &manifold);
    EXPECT_EQ(manifold.contacts.empty(), height <= 0) << "what lies in each other pushes inwards";
  }
}

TEST(FadingPoints, AreReadAsTheyWereWritten) {
  const geometry::StateContent saved = contentOf(comingAndLeaving());
  FadingPoints read;
  geometry::StateReader reader(saved);
  read.restore(threePoints(), &reader);
  EXPECT_EQ(reader.wordsLeft(), 0u);
  EXPECT_EQ(contentOf(read).words, saved.words);
}

TEST(FadingPoints, WordsThatLieAreRefused) {
  const std::vector<std::uint64_t> words = contentOf(comingAndLeaving()).words;
  const std::vector<contact::Collider> colliders = threePoints();
  const auto isRead = [&](const std::vector<std::uint64_t>& given) {
    const geometry::StateContent content{{}, given};
    geometry::StateReader reader(content);
    try {
      FadingPoints().restore(colliders, &reader);
    } catch (const InputError&) {
      return false;
    }
    return true;
  };
  for (std::size_t length = 0; length < words.size(); ++length)
    EXPECT_FALSE(isRead({words.begin(), words.begin() + static_cast<std::ptrdiff_t>(length)})) << length;
  // Number of crossings, and one of them.
  for (const std::size_t back : {1, 2, 3})
    for (const std::uint64_t lie : {std::uint64_t{7}, ~std::uint64_t{0}}) {
      std::vector<std::uint64_t> lying = words;
      lying[words.size() - back] = lie;
      EXPECT_FALSE(isRead(lying)) << back << " " << lie;
    }
  // Number of colliders, collider, speed, number of points, vertex, sink.
  for (const std::size_t at : {0, 1, 3, 4})
    for (const std::uint64_t lie : {std::uint64_t{7}, ~std::uint64_t{0}, std::uint64_t{1} << 63}) {
      std::vector<std::uint64_t> lying = words;
      lying[at] = lie;
      EXPECT_FALSE(isRead(lying)) << at << " " << lie;
    }
  for (const std::size_t at : {2, 5}) {
    std::vector<std::uint64_t> lying = words;
    lying[at] = 0x7FF8000000000000;  // NaN
    EXPECT_FALSE(isRead(lying)) << at;
  }
}

}  // namespace
}  // namespace blem_sim::sim
