// Search for candidates: the same in parts as at once, and none is missed for its directions.
#include "search/candidate_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "contact/contact_shapes.h"
#include "features/feature_cones.h"
#include "features/tolerances.h"
#include "neighbourhood/surroundings.h"
#include "neighbourhood/vertex_cone.h"

namespace blem_sim::contact {
namespace {

MeshPair searchedPair(const Collider& moving, const Collider& fixed, const Pose& X_FM) {
  const double layer = moving.radius + fixed.radius;
  return {MeshSide(*moving.geometry), MeshSide(*fixed.geometry), X_FM, layer, layer, {}};
}

using NamedPairs = std::vector<std::pair<int, int>>;

template <typename First, typename Second>
NamedPairs named(const std::vector<kernels::Candidate>& candidates, const FeatureRecords<First>& a, const FeatureRecords<Second>& b) {
  NamedPairs out;
  for (const kernels::Candidate& c : candidates) out.emplace_back(a.names[c.first], b.names[c.second]);
  return out;
}

/** All candidates, by the names of their features, in their order. */
std::vector<NamedPairs> namesOf(const CandidateLists& lists) {
  std::vector<NamedPairs> out;
  for (const Side side : SIDES) {
    const NearFeatures &own = lists.near[side], &partner = lists.near[!side];
    out.push_back(named(lists.pairs.vertex_face[side], own.vertices, partner.faces));
    out.push_back(named(lists.pairs.vertex_edge[side], own.vertices, partner.edges));
    out.push_back(named(lists.pairs.edge_face[side], own.edges, partner.faces));
  }
  out.push_back(named(lists.pairs.edge_edge, lists.near.moving.edges, lists.near.fixed.edges));
  out.push_back(named(lists.pairs.vertex_vertex, lists.near.moving.vertices, lists.near.fixed.vertices));
  return out;
}

// Between the parts of a search the pair moves on, and other searches ask for the same leaves.
TEST(CandidateSearch, InPartsAsAtOnce) {
  geometry::RandomShapes random(3);
  const Collider hills = makeCollider(hillMesh(random, 0.1, 60, 0.001), 0), ball = makeCollider(geometry::icosphereMesh(0.02, 4), 0.002);
  const Pose X = makePose({0.001, 0.002, 0.0205}, {0.1, 0.2, 0.3}), other = makePose({-0.004, 0.001, 0.0201}, {0.3, 0, 0.1});
  const ListMargin margin{0.001, 0.02};
  for (const CandidateKind kind : {CandidateKind::CONTACTS, CandidateKind::CROSSINGS}) {
    CandidateSearchBuffers buffers;
    CandidateListing whole, parts, between;
    findCandidates(searchedPair(ball, hills, X), kind, margin, &buffers, &whole);
    ASSERT_GT(whole.pairs.size(), 100u);
    beginCandidates(searchedPair(ball, hills, X), kind, margin, &buffers, &parts);
    EXPECT_FALSE(parts.isComplete());
    while (!parts.isComplete()) {
      findMoreCandidates(searchedPair(ball, hills, other), 37, &buffers, &parts);
      findCandidates(searchedPair(ball, hills, other), CandidateKind::CONTACTS, margin, &buffers, &between);
      findCandidates(searchedPair(hills, ball, other.inverse()), CandidateKind::CONTACTS, margin, &buffers, &between);
    }
    EXPECT_EQ(namesOf(parts.lists), namesOf(whole.lists));
    for (const Side side : SIDES) {
      const NearFeatures &near = parts.lists.near[side], &expected = whole.lists.near[side];
      EXPECT_EQ(near.vertices.names, expected.vertices.names);
      EXPECT_EQ(near.edges.names, expected.edges.names);
      EXPECT_EQ(near.faces.names, expected.faces.names);
      EXPECT_EQ(near.patches, expected.patches);
    }
  }
}

bool holds(const kernels::VertexCone& cone, const Vector3& direction) {
  const Vector3 axis(cone.axis[0], cone.axis[1], cone.axis[2]);
  const double along = axis.dot(direction), most = std::abs(along) * (along > 0 ? cone.up : cone.down);
  return most >= 0 && direction.squaredNorm() - along * along <= most * most;
}

// A vertex's cone holds every direction in which the vertex is the nearest of its surface.
TEST(VertexCone, HoldsEveryDirectionThatIsAllowed) {
  geometry::RandomShapes random(4);
  int allowed = 0, refused = 0;
  for (const geometry::TriangleMesh& mesh : {geometry::boxMesh(Vector3::Constant(0.1)), geometry::icosphereMesh(0.1, 2),
                                             hillMesh(random, 0.1, 6, 0.01), soupMesh(random, 20, 0.02)}) {
    const Collider collider = makeCollider(mesh, 0);
    const MeshSide side(*collider.geometry);
    SurroundingsMemory surroundings;
    std::vector<double> angles;
    for (int vertex = 0; vertex < static_cast<int>(side.mesh.vertices.size()); ++vertex) {
      const kernels::VertexCone cone = vertexCone(side, vertex, &surroundings, &angles);
      const Vector3 axis(cone.axis[0], cone.axis[1], cone.axis[2]);
      for (int i = 0; i < 200; ++i) {
        const Vector3 direction = (random.point(1) + (i % 4) * random.uniform(-3, 3) * axis).normalized();
        const bool allows = vertexConeAllows(surroundings.ofVertex(side, vertex), direction, CONE_SLACK);
        EXPECT_TRUE(!allows || holds(cone, direction)) << vertex;
        allowed += allows;
        refused += !holds(cone, direction);
      }
    }
  }
  EXPECT_GT(allowed, 1000);
  EXPECT_GT(refused, 10000);
}

}  // namespace
}  // namespace blem_sim::contact
