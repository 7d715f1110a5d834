// The smallest distance among the contacts is the distance of the meshes, by brute force over all pairs of triangles. Brute force and
// search share no code; where both meshes are within rounding of touching, the distance is the oracle's to call and either may say 0.
#include <gtest/gtest.h>

#include "blem_sim/geometry/closest_points.h"
#include "contact/contact_shapes.h"
#include "support/sanitizers.h"

namespace blem_sim::contact {
namespace {

constexpr double EXTENT = 0.1;
constexpr double REACH = 0.01;

struct PosedShape {
  const char* name;
  Collider collider;
};

std::vector<PosedShape> makePosedShapes() {
  geometry::RandomShapes random(7);
  std::vector<PosedShape> shapes;
  shapes.push_back({"cube", makeCollider(geometry::boxMesh(Vector3::Constant(EXTENT)), REACH / 2)});
  shapes.push_back({"slab", makeCollider(geometry::boxMesh({EXTENT, 0.5 * EXTENT, 0.02 * EXTENT}), REACH / 2)});
  shapes.push_back({"octahedron", makeCollider(octahedronMesh(0.5 * EXTENT), REACH / 2)});
  shapes.push_back({"fine cube", makeCollider(geometry::subdivided(geometry::boxMesh(Vector3::Constant(EXTENT)), 1), REACH / 2)});
  shapes.push_back({"grid", makeCollider(geometry::gridMesh(EXTENT, EXTENT, 3, 2), REACH / 2)});
  shapes.push_back({"hills", makeCollider(hillMesh(random, EXTENT, 4, 0.1 * EXTENT), REACH / 2)});
  shapes.push_back({"soup", makeCollider(soupMesh(random, 12, 0.5 * EXTENT), REACH / 2)});
  shapes.push_back({"point", makeCollider(geometry::pointMesh(Vector3(0.01, 0, 0)), REACH / 2)});
  shapes.push_back({"segment", makeCollider(geometry::segmentMesh(Vector3(-0.5 * EXTENT, 0, 0), Vector3(0.5 * EXTENT, 0, 0)), REACH / 2)});
  return shapes;
}

class Completeness {
 public:
  int poses = 0, within = 0, apart = 0, meeting = 0;
  double worst = 0;

  void check(const PosedShape& a, const PosedShape& b, const Pose& X_BA) {
    ++poses;
    const geometry::ClosestPoints exact =
        geometry::closestMeshMeshBruteForce(a.collider.geometry->mesh(), b.collider.geometry->mesh(), X_BA);
    const ContactManifold manifold = contactsOf(a.collider, X_BA, b.collider, Pose::Identity());
    ASSERT_TRUE(allFinite(manifold));
    if (exact.distance > REACH) {
      ++apart;
      if (exact.distance > REACH + 1e-9) {
        ASSERT_TRUE(manifold.contacts.empty()) << a.name << " on " << b.name;
      }
    } else if (exact.distance > 1e-12) {
      ++within;
      ASSERT_FALSE(manifold.contacts.empty()) << a.name << " on " << b.name << " distance " << exact.distance << "\n" << X_BA.matrix();
      const double error = std::abs(manifold.layer - manifold.maxDepth() - exact.distance);
      worst = std::max(worst, error);
      ASSERT_LE(error, 1e-8) << a.name << " on " << b.name << " distance " << exact.distance << "\n" << X_BA.matrix();
      ASSERT_TRUE(exact.distance < 1e-8 || !manifold.pierced) << a.name << " on " << b.name;
    } else {
      ++meeting;
      ASSERT_FALSE(manifold.contacts.empty()) << a.name << " meets " << b.name << "\n" << X_BA.matrix();
      ASSERT_GE(manifold.maxDepth(), manifold.layer - 1e-8) << a.name << " meets " << b.name << "\n" << X_BA.matrix();
    }
  }
};

/** Moves A along the shortest way to B until `gap` is left. */
Pose approached(const PosedShape& a, const PosedShape& b, Pose X_BA, double gap) {
  const geometry::ClosestPoints exact = geometry::closestMeshMeshBruteForce(a.collider.geometry->mesh(), b.collider.geometry->mesh(), X_BA);
  if (exact.distance > gap) X_BA.pretranslate((exact.point_b - exact.point_a) * (1 - gap / exact.distance));
  return X_BA;
}

TEST(NarrowPhaseCompleteness, RandomPoses) {
  const std::vector<PosedShape> shapes = makePosedShapes();
  geometry::RandomShapes random(1);
  Completeness all;
  while (all.poses < samples(12000)) {
    const PosedShape& a = shapes[random.integer(0, shapes.size() - 1)];
    const PosedShape& b = shapes[random.integer(0, shapes.size() - 1)];
    Pose X_BA = random.pose(1);
    X_BA.translation() = X_BA.translation().normalized() * 2 * EXTENT;
    const double gap = REACH * std::pow(10, random.uniform(-8, 0));
    all.check(a, b, approached(a, b, X_BA, gap));
    if (HasFatalFailure()) return;
  }
  RecordProperty("within_layer", all.within);
  EXPECT_GT(all.within, samples(10000));
  std::printf("random: %d within the layer, %d apart, %d meeting, worst error %.2g m\n", all.within, all.apart, all.meeting, all.worst);
}

TEST(NarrowPhaseCompleteness, AxisAlignedPoses) {
  const std::vector<PosedShape> shapes = makePosedShapes();
  geometry::RandomShapes random(2);
  Completeness all;
  while (all.poses < samples(12000)) {
    const PosedShape& a = shapes[random.integer(0, shapes.size() - 1)];
    const PosedShape& b = shapes[random.integer(0, shapes.size() - 1)];
    Pose X_BA = Pose::Identity();
    X_BA.linear() = axisRotation(random);
    // Centres on a lattice: faces over faces, edges over edges, corners over corners; then apart along one axis.
    for (int k = 0; k < 3; ++k) X_BA.translation()[k] = 0.25 * EXTENT * random.integer(-4, 4);
    const int axis = random.integer(0, 2);
    X_BA.translation()[axis] = 2 * EXTENT * (random.integer(0, 1) ? 1 : -1);
    const double gap = random.integer(0, 9) == 0 ? 0 : REACH * std::pow(10, random.uniform(-8, 0));
    all.check(a, b, approached(a, b, X_BA, gap));
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(all.within, samples(6000));
  std::printf("aligned: %d within the layer, %d apart, %d meeting, worst error %.2g m\n", all.within, all.apart, all.meeting, all.worst);
}

TEST(NarrowPhaseCompleteness, NearlyAlignedPoses) {
  const std::vector<PosedShape> shapes = makePosedShapes();
  geometry::RandomShapes random(3);
  Completeness all;
  while (all.poses < samples(6000)) {
    const PosedShape& a = shapes[random.integer(0, shapes.size() - 1)];
    const PosedShape& b = shapes[random.integer(0, shapes.size() - 1)];
    const double tilt = std::pow(10, random.uniform(-9, -2));
    Pose X_BA = makePose(Vector3::Zero(), random.point(tilt));
    X_BA.linear() = X_BA.linear() * axisRotation(random);
    for (int k = 0; k < 2; ++k) X_BA.translation()[k] = 0.25 * EXTENT * random.integer(-4, 4) + random.uniform(-tilt, tilt) * EXTENT;
    X_BA.translation().z() = 2 * EXTENT;
    all.check(a, b, approached(a, b, X_BA, REACH * std::pow(10, random.uniform(-8, 0))));
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(all.within, samples(3000));
  std::printf("nearly aligned: %d within the layer, %d apart, %d meeting, worst error %.2g m\n", all.within, all.apart, all.meeting,
              all.worst);
}

/** An edge that touches a corner passes the plane of a side beside it, on a diagonal of that side: no crossing. */
TEST(NarrowPhaseCompleteness, EdgeGrazesACorner) {
  const std::vector<PosedShape> shapes = makePosedShapes();
  Pose X_BA = Pose::Identity();
  X_BA.matrix() << -0.0027391364947207566, 0.99999624181455637, 0.00011613796312474911, -0.074863065371878396,  //
      0.99999190526702708, 0.0027394668744232238, -0.0029469851823538426, -0.050324844976090528,                //
      -0.0029472922631398712, 0.0001080648283565629, -0.99999565088569686, 0.0021446587488663238,               //
      0, 0, 0, 1;
  Completeness one;
  one.check(shapes[1], shapes[1], X_BA);
  EXPECT_EQ(one.within, 1);
}

/** Deep poses: meshes that meet have contacts, all finite, none deeper than the layer by more than the smaller body. */
TEST(NarrowPhaseCompleteness, MeetingPosesAreFiniteAndBounded) {
  const std::vector<PosedShape> shapes = makePosedShapes();
  geometry::RandomShapes random(4);
  int pierced = 0;
  for (int i = 0; i < samples(3000); ++i) {
    const PosedShape& a = shapes[random.integer(0, shapes.size() - 1)];
    const PosedShape& b = shapes[random.integer(0, shapes.size() - 1)];
    const Pose X_BA = random.pose(EXTENT);
    const ContactManifold manifold = contactsOf(a.collider, X_BA, b.collider, Pose::Identity());
    ASSERT_TRUE(allFinite(manifold));
    if (!manifold.pierced) continue;
    ++pierced;
    const double exact = geometry::closestMeshMeshBruteForce(a.collider.geometry->mesh(), b.collider.geometry->mesh(), X_BA).distance;
    ASSERT_EQ(exact, 0) << a.name << " " << b.name;
    ASSERT_TRUE(std::any_of(manifold.contacts.begin(), manifold.contacts.end(), [](const Contact& c) { return c.pierced; }));
    const double smaller = std::min(a.collider.geometry->bounds().diagonal().norm(), b.collider.geometry->bounds().diagonal().norm());
    ASSERT_LE(manifold.maxDepth(), manifold.layer + 0.5 * smaller);
  }
  EXPECT_GT(pierced, samples(500));
}

}  // namespace
}  // namespace blem_sim::contact
