// Contacts must not depend on: order of the pair, the pair's place, order of triangles, winding, faces given twice, tessellation of planes.
#include <gtest/gtest.h>

#include <numeric>

#include "blem_sim/reduction/reduction.h"
#include "contact/contact_shapes.h"

namespace blem_sim::contact {
namespace {

constexpr double TOLERANCE = 1e-9;

/** Contacts of both in one another, both ways, so that neither has one more. */
void expectSame(const ContactManifold& a, const ContactManifold& b, double tolerance = TOLERANCE) {
  EXPECT_EQ(a.contacts.size(), b.contacts.size());
  EXPECT_EQ(a.pierced, b.pierced);
  EXPECT_NEAR(largestDifference(a.contacts, b.contacts), 0, tolerance);
  EXPECT_NEAR(largestDifference(b.contacts, a.contacts), 0, tolerance);
}

struct Case {
  geometry::TriangleMesh a, b;
  Pose X_WA;
};

/** Poses within the layer: boxes, hills and soups in all positions, no two features exactly coincident. */
std::vector<Case> makeCases(int count) {
  geometry::RandomShapes random(21);
  std::vector<Case> cases;
  const geometry::TriangleMesh hills = hillMesh(random, 0.4, 12, 0.01), box = geometry::boxMesh({0.1, 0.08, 0.06}),
                               soup = soupMesh(random, 20, 0.05);
  for (int i = 0; i < count; ++i) {
    const geometry::TriangleMesh& a = i % 3 == 2 ? soup : box;
    cases.push_back({a, i % 2 ? hills : geometry::subdivided(box, i % 4 / 2), makePose(random.point(0.08), random.point(3))});
  }
  return cases;
}

Collider layered(const geometry::TriangleMesh& mesh, double radius = 0.004) { return makeCollider(mesh, radius); }

geometry::TriangleMesh rewound(const geometry::TriangleMesh& mesh, geometry::RandomShapes& random) {
  geometry::TriangleMesh out = mesh;
  for (Vector3i& e : out.elements) {
    if (random.integer(0, 1) && e[0] != e[1] && e[1] != e[2]) std::swap(e[1], e[2]);
  }
  return out;
}

geometry::TriangleMesh shuffled(const geometry::TriangleMesh& mesh, geometry::RandomShapes& random) {
  geometry::TriangleMesh out = mesh;
  for (std::size_t i = out.elements.size(); i > 1; --i) std::swap(out.elements[i - 1], out.elements[random.integer(0, i - 1)]);
  std::vector<int> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.integer(0, i - 1)]);
  for (std::size_t i = 0; i < order.size(); ++i) out.vertices[order[i]] = mesh.vertices[i];
  for (Vector3i& e : out.elements) e = Vector3i(order[e[0]], order[e[1]], order[e[2]]);
  return out;
}

TEST(NarrowPhaseInvariance, SwappedPairIsMirrored) {
  int contacts = 0;
  for (const Case& c : makeCases(300)) {
    const Collider a = layered(c.a, 0.005), b = layered(c.b, 0.002);
    const ContactManifold ab = contactsOf(a, c.X_WA, b, Pose::Identity());
    ContactManifold ba = contactsOf(b, Pose::Identity(), a, c.X_WA);
    for (Contact& contact : ba.contacts) contact.normal_BA = -contact.normal_BA;
    expectSame(ab, ba);
    contacts += ab.contacts.size();
  }
  EXPECT_GT(contacts, 2000);
}

TEST(NarrowPhaseInvariance, MovedPairHasMovedContacts) {
  geometry::RandomShapes random(22);
  for (const Case& c : makeCases(300)) {
    const Collider a = layered(c.a), b = layered(c.b);
    const ContactManifold here = contactsOf(a, c.X_WA, b, Pose::Identity());
    const Pose X_VW = random.pose(5);
    ContactManifold there = contactsOf(a, X_VW * c.X_WA, b, X_VW);
    for (Contact& contact : there.contacts) {
      contact.point = X_VW.inverse() * contact.point;
      contact.normal_BA = X_VW.linear().transpose() * contact.normal_BA;
    }
    expectSame(here, there);
  }
}

TEST(NarrowPhaseInvariance, WindingDoesNotMatter) {
  geometry::RandomShapes random(23);
  for (const Case& c : makeCases(300)) {
    expectSame(contactsOf(layered(c.a), c.X_WA, layered(c.b), Pose::Identity()),
               contactsOf(layered(rewound(c.a, random)), c.X_WA, layered(rewound(c.b, random)), Pose::Identity()));
  }
}

TEST(NarrowPhaseInvariance, OrderOfTrianglesDoesNotMatter) {
  geometry::RandomShapes random(24);
  for (const Case& c : makeCases(300)) {
    expectSame(contactsOf(layered(c.a), c.X_WA, layered(c.b), Pose::Identity()),
               contactsOf(layered(shuffled(c.a, random)), c.X_WA, layered(shuffled(c.b, random)), Pose::Identity()));
  }
}

TEST(NarrowPhaseInvariance, FacesGivenTwiceDoNotMatter) {
  for (const Case& c : makeCases(100)) {
    geometry::TriangleMesh twice = c.b;
    for (std::size_t i = 0; i < c.b.elements.size(); i += 2) {
      const Vector3i& e = c.b.elements[i];
      if (c.b.isTriangle(static_cast<int>(i))) twice.elements.push_back({e[2], e[1], e[0]});
    }
    const ContactManifold once = contactsOf(layered(c.a), c.X_WA, layered(c.b), Pose::Identity());
    expectSame(once, contactsOf(layered(c.a), c.X_WA, layered(geometry::cleanMesh(twice, nullptr)), Pose::Identity()));
  }
}

TEST(NarrowPhaseInvariance, UnweldedCopyIsWeldedOnLoading) {
  for (const Case& c : makeCases(100)) {
    geometry::TriangleMesh soup;
    for (const Vector3i& e : c.b.elements) {
      const int first = static_cast<int>(soup.vertices.size());
      for (int k = 0; k < 3; ++k) soup.vertices.push_back(c.b.vertices[e[k]]);
      soup.elements.push_back({first, first + 1, first + 2});
    }
    expectSame(contactsOf(layered(c.a), c.X_WA, layered(c.b), Pose::Identity()),
               contactsOf(layered(c.a), c.X_WA, layered(geometry::cleanMesh(soup, nullptr)), Pose::Identity()));
  }
}

/** Splitting a plane's triangles adds nothing; splitting a straight edge adds points on it, but no other normal and nothing deeper. */
TEST(NarrowPhaseInvariance, SubdivisionKeepsTheDeepest) {
  for (const Case& c : makeCases(200)) {
    const ContactManifold coarse = contactsOf(layered(c.a), c.X_WA, layered(c.b), Pose::Identity());
    const ContactManifold fine = contactsOf(layered(c.a), c.X_WA, layered(geometry::subdivided(c.b, 2)), Pose::Identity());
    EXPECT_EQ(coarse.pierced, fine.pierced);
    if (coarse.pierced) continue;
    ASSERT_EQ(coarse.contacts.empty(), fine.contacts.empty());
    if (coarse.contacts.empty()) continue;
    EXPECT_NEAR(coarse.maxDepth(), fine.maxDepth(), TOLERANCE);
    EXPECT_NEAR(largestDifference(coarse.contacts, fine.contacts), 0, TOLERANCE);
  }
}

/** Push of deep layers together, every contact of the reduced set by its depth: force and torque about the origin. */
Eigen::Matrix<double, 6, 1> netWrench(const geometry::TriangleMesh& a, const Pose& X_WA, const geometry::TriangleMesh& b) {
  ContactManifold manifold = contactsOf(layered(a), X_WA, layered(b), Pose::Identity());
  reduction::reduceHull(manifold.contacts, 50);
  Eigen::Matrix<double, 6, 1> wrench = Eigen::Matrix<double, 6, 1>::Zero();
  for (const Contact& c : manifold.contacts) {
    const Vector3 force = std::max(0.0, c.depth) * c.normal_BA;
    wrench.head<3>() += force;
    wrench.tail<3>() += c.point.cross(force);
  }
  return wrench;
}

/** Soups flat on one another push the same for any tessellation; tilted only for one, since an edge in pieces has more contacts along it.
 */
TEST(NarrowPhaseInvariance, CopiesOfASoupPushTheSame) {
  geometry::RandomShapes random(25);
  const geometry::TriangleMesh cube = geometry::boxMesh(Vector3::Constant(0.1));
  for (int i = 0; i < 200; ++i) {
    const double tilt = i % 2 ? 0.005 : 0;
    const Pose X_WA = makePose({random.uniform(-0.08, 0.08), random.uniform(-0.08, 0.08), 0.107},
                               {tilt * random.uniform(-1, 1), tilt, i % 4 < 2 ? 0 : 0.4});
    const Eigen::Matrix<double, 6, 1> plain = netWrench(cube, X_WA, cube);
    geometry::TriangleMesh twice = geometry::subdivided(cube, i % 2 ? 0 : 2);
    for (std::size_t e = 0; e < twice.elements.size(); e += 2) {
      const Vector3i element = twice.elements[e];
      twice.elements.push_back({element[2], element[1], element[0]});
    }
    const geometry::TriangleMesh copy = rewound(shuffled(geometry::cleanMesh(twice, nullptr), random), random);
    EXPECT_LE((netWrench(copy, X_WA, copy) - plain).norm(), 1e-6 * plain.norm() + 1e-12) << i;
  }
}

}  // namespace
}  // namespace blem_sim::contact
