// Around round edges and vertices (ROUND_COSINE) a vertex of any shape belongs to whichever feature is nearest to it.
#include <gtest/gtest.h>

#include "blem_sim/geometry/closest_points.h"
#include "contact/contact_shapes.h"
#include "features/mesh_pair.h"

namespace blem_sim::contact {
namespace {

constexpr double ROUND_WIDTH = 0.002;

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  int features = 0;  ///< of the triangle there: 1 a vertex, 2 an edge, 3 the face
};

Nearest nearestTo(const Vector3& p, const geometry::TriangleMesh& mesh) {
  Nearest out;
  for (const Vector3i& e : mesh.elements) {
    const geometry::Triangle triangle{mesh.vertices[e[0]], mesh.vertices[e[1]], mesh.vertices[e[2]]};
    const Vector3 q = geometry::closestPointTriangle(p, triangle).point_b;
    if ((p - q).norm() >= out.distance) continue;
    out.distance = (p - q).norm();
    out.features = 3;
    for (int k = 0; k < 3; ++k) {
      const Vector3 along = triangle[(k + 1) % 3] - triangle[k];
      if ((q - triangle[k]).cross(along).norm() < 1e-9 * along.norm()) out.features = 2;
    }
    for (const Vector3& corner : triangle)
      if ((q - corner).norm() < 1e-9) out.features = 1;
  }
  return out;
}

/** Depth of the deepest contact of A's vertex 0. */
double depthOfFirstVertex(const Collider& a, const Collider& b) {
  ContactManifold manifold;
  narrowPhase({a, Pose::Identity()}, {b, Pose::Identity()}, {0}, searchRoom(), &manifold);
  EXPECT_FALSE(manifold.pierced);
  double depth = -1;
  for (const Contact& c : manifold.contacts)
    if (c.id >> 32 == contactId({FeatureKind::VERTEX, 0}, {FeatureKind::VERTEX, 0}) >> 32) depth = std::max(depth, c.depth);
  return depth;
}

/** A blade whose tip is not its nearest point: its other end lies closer to the ball. */
TEST(RoundSurfaces, AVertexThatLeadsDownKeepsItsContact) {
  geometry::RandomShapes random(11);
  const geometry::TriangleMesh mesh = geometry::icosphereMesh(0.03, 3);
  const Collider ball = makeCollider(mesh, ROUND_WIDTH);
  int at[4] = {};
  for (int i = 0; i < 600; ++i) {
    const Vector3& corner = mesh.vertices[random.integer(0, static_cast<int>(mesh.vertices.size()) - 1)];
    const Vector3 up = (corner.normalized() + (i % 2 ? 0.01 : 0.2) * random.point(1)).normalized(), aside = up.unitOrthogonal();
    const Vector3 tip = 0.0315 * up;
    const geometry::TriangleMesh blade{{tip, tip + 0.004 * aside - 0.0004 * up, tip + 0.004 * aside + 0.002 * up}, {{0, 1, 2}}};
    const Nearest nearest = nearestTo(tip, mesh);
    ++at[nearest.features];
    EXPECT_NEAR(depthOfFirstVertex(makeCollider(blade, ROUND_WIDTH), ball), 2 * ROUND_WIDTH - nearest.distance, 1e-9)
        << i << ": " << nearest.features;
  }
  for (int features = 1; features <= 3; ++features) EXPECT_GT(at[features], 20) << features;
}

}  // namespace
}  // namespace blem_sim::contact
