// Directions of a surface's normals.
#include "kept/direction_ball.h"

#include <gtest/gtest.h>

#include <vector>

#include "contact/contact_shapes.h"
#include "features/tolerances.h"
#include "neighbourhood/surroundings.h"
#include "search/candidate_search.h"

namespace blem_sim::contact {
namespace {

TEST(DirectionBall, HoldsWhatWasAdded) {
  geometry::RandomShapes random(3);
  DirectionBall ball;
  EXPECT_EQ(ball.most(Vector3::UnitX()), 0);
  std::vector<Vector3> directions;
  for (int i = 0; i < 30; ++i) {
    const Vector3 centre = (Vector3::UnitZ() + random.point(0.01 * i)).normalized();
    const double radius = 0.003 * (i % 7);
    ball.add(i % 3 == 0 ? Vector3(-centre) : centre, radius);
    for (int k = 0; k < 20; ++k) {
      const Vector3 direction = centre + radius * random.point(1).normalized();
      if (direction.norm() <= 1) directions.push_back(direction);
    }
    const Vector3 v = random.point(2);
    for (const Vector3& direction : directions) EXPECT_LE(std::abs(direction.dot(v)), ball.most(v) + 1e-12) << i;
    EXPECT_LE(ball.most(v), v.norm());
  }
  EXPECT_LT(ball.most(Vector3::UnitX()), 0.8);
}

// The ball of a listing's directions holds the normals of its faces, and all directions that the cones of its vertices allow.
TEST(DirectionBall, HoldsTheNormalsOfAListing) {
  geometry::RandomShapes random(4);
  geometry::TriangleMesh plain_and_hills = hillMesh(random, 0.1, 60, 0.0001);
  for (Vector3& v : plain_and_hills.vertices) v.z() *= v.x() < 0 ? 0.01 : 1;
  const Collider hills = makeCollider(plain_and_hills, 0), cube = makeCollider(geometry::boxMesh(Vector3::Constant(0.02)), 0.002);
  const MeshPair pair{MeshSide(*cube.geometry), MeshSide(*hills.geometry), makePose({0, 0, 0.0105}), 0.002, 0.002, {}};
  CandidateSearchBuffers buffers;
  CandidateListing listing;
  findCandidates(pair, CandidateKind::CONTACTS, {0.001, 0.01}, &buffers, &listing);
  const NearFeatures& near = listing.lists.near.fixed;
  ASSERT_GT(near.faces.names.size(), 50u);
  SurroundingsMemory surroundings;
  for (int i = 0; i < 1000; ++i) {
    const Vector3 v = random.point(1);
    const double most = listing.normals.most(v) + 1e-12;
    for (const int face : near.faces.names) EXPECT_LE(std::abs(v.dot(geometry::MeshTopology::normal(pair.fixed.mesh, face))), most);
    const Vector3 d = (Vector3::UnitZ() + 0.5 * random.point(1)).normalized();
    for (const int vertex : near.vertices.names) {
      const bool is_normal = vertexConeAllows(surroundings.ofVertex(pair.fixed, vertex), d, CONE_SLACK);
      EXPECT_TRUE(!is_normal || std::abs(v.dot(d)) <= most);
    }
  }
  EXPECT_LT(listing.normals.most(Vector3::UnitX()), 0.5);
}

}  // namespace
}  // namespace blem_sim::contact
