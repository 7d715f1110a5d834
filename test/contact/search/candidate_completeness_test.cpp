// Lists hold every contact and every crossing: those of all pairs of features are those of the candidates, wherever the pair has moved
// within the margin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "contact/contact_shapes.h"
#include "evaluation/contact_evaluation.h"
#include "search/candidate_search.h"
#include "support/sanitizers.h"

namespace blem_sim::contact {
namespace {

constexpr double SIZE = 0.1, LAYER = 0.015;  // [m]
constexpr kernels::OpenSides ALL_SIDES = 63;

geometry::TriangleMesh torusMesh(double radius, double thickness, int around, int across) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * (j + 0.5 * i) / across, r = radius + thickness * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), thickness * std::sin(v));
      // Half a step further on than the row before: the last row meets the first one where they are a whole number of steps apart.
      const int next_row = (i + 1) % around * across, shift = i + 1 == around ? around / 2 : 0, next = (j + 1) % across;
      const int a = i * across + j, b = i * across + next, c = next_row + (j + shift) % across, d = next_row + (next + shift) % across;
      mesh.elements.emplace_back(a, c, b);
      mesh.elements.emplace_back(b, c, d);
    }
  }
  return mesh;
}

/** A mesh of curvatures x and y [1/m] along its axes. */
geometry::TriangleMesh curvedMesh(double x, double y) {
  geometry::TriangleMesh mesh = geometry::gridMesh(SIZE, SIZE, 13, 13);
  for (Vector3& v : mesh.vertices) v.z() = 0.5 * (x * v.x() * v.x() + y * v.y() * v.y());
  return mesh;
}

geometry::TriangleMesh shaken(geometry::TriangleMesh mesh, geometry::RandomShapes& random, double by) {
  for (Vector3& v : mesh.vertices) v += random.point(by);
  return mesh;
}

struct Shape {
  std::string name;
  Collider collider;
};

std::vector<Shape> makeShapes() {
  geometry::RandomShapes random(11);
  std::vector<Shape> shapes;
  const auto add = [&](const char* name, geometry::TriangleMesh mesh) {
    shapes.push_back({name, makeCollider(std::move(mesh), 0.5 * LAYER)});
  };
  add("ball", geometry::icosphereMesh(0.5 * SIZE, 2));
  add("rough ball", shaken(geometry::icosphereMesh(0.5 * SIZE, 2), random, 0.0008));
  add("torus", torusMesh(0.35 * SIZE, 0.12 * SIZE, 24, 10));
  add("fine torus", torusMesh(0.6 * SIZE, 0.4 * SIZE, 36, 24));
  add("dome", curvedMesh(-7, -5));
  add("saddle", curvedMesh(6, -4));
  add("rough saddle", shaken(curvedMesh(3, -4), random, 0.0002));
  add("gentle hills", hillMesh(random, SIZE, 10, 0.005 * SIZE));
  add("steep hills", hillMesh(random, SIZE, 8, 0.06 * SIZE));
  add("cube", geometry::subdivided(geometry::boxMesh(Vector3::Constant(0.6 * SIZE)), 1));
  add("octahedron", octahedronMesh(0.5 * SIZE));
  add("soup", soupMesh(random, 25, 0.4 * SIZE));
  add("segment", geometry::segmentMesh(Vector3(-0.5 * SIZE, 0, 0), Vector3(0.5 * SIZE, 0, 0)));
  return shapes;
}

MeshPair pairOf(const Collider& moving, const Collider& fixed, const Pose& X_FM) {
  return {MeshSide(*moving.geometry), MeshSide(*fixed.geometry), X_FM, LAYER, LAYER, {}};
}

NearFeatures allFeatures(const MeshSide& side, LeafMemory* leaves, SurroundingsMemory* surroundings) {
  NearFeatures all;
  for (std::uint32_t node = 0; node < side.bvh.nodes().size(); ++node) {
    if (!side.bvh.nodes()[node].isLeaf()) continue;
    const LeafFeatures& leaf = leaves->describe(side, node, surroundings, &leaves->find(side, node, 1));
    const auto add = [](const auto& kind, auto* to) {
      for (std::size_t i = 0; i < kind.records.size(); ++i) to->add(kind.records[i], kind.names[i]);
    };
    add(leaf.vertices, &all.vertices);
    add(leaf.edges, &all.edges);
    add(leaf.faces, &all.faces);
    for (std::uint32_t i = 0; i < leaf.faces.records.size(); ++i) all.addFaceOf(leaf, i, false);
  }
  std::fill(all.open.begin(), all.open.end(), ALL_SIDES);
  return all;
}

template <typename A, typename B>
std::vector<kernels::Candidate> allPairs(const FeatureRecords<A>& a, const FeatureRecords<B>& b) {
  std::vector<kernels::Candidate> all;
  for (std::uint32_t i = 0; i < a.names.size(); ++i)
    for (std::uint32_t j = 0; j < b.names.size(); ++j) all.push_back({i, j});
  return all;
}

CandidateLists everything(const MeshPair& pair, SurroundingsMemory* surroundings) {
  LeafMemory leaves;
  CandidateLists lists;
  for (const Side side : SIDES) lists.near[side] = allFeatures(pair.side(side), &leaves, surroundings);
  const NearFeatures &m = lists.near.moving, &f = lists.near.fixed;
  lists.pairs.vertex_face.moving = allPairs(m.vertices, f.faces);
  lists.pairs.vertex_face.fixed = allPairs(f.vertices, m.faces);
  lists.pairs.vertex_edge.moving = allPairs(m.vertices, f.edges);
  lists.pairs.vertex_edge.fixed = allPairs(f.vertices, m.edges);
  lists.pairs.edge_edge = allPairs(m.edges, f.edges);
  lists.pairs.vertex_vertex = allPairs(m.vertices, f.vertices);
  lists.pairs.edge_face.moving = allPairs(m.edges, f.faces);
  lists.pairs.edge_face.fixed = allPairs(f.edges, m.faces);
  return lists;
}

using NamedContact = std::tuple<int, int, int, int, double>;

std::vector<NamedContact> contactsOf(const MeshPair& pair, CandidateLists* lists, const CandidatePairs& pairs, EvaluationBuffers* buffers) {
  std::vector<Contact> plain;
  EvaluatedContacts found;
  found.plain.overwrite(&plain);
  found.clear();
  buffers->turned.turnForContacts(*lists, pair.X_FM);
  // As if the meshes crossed: then no contact is plain, and all name their features.
  found.crossings.push_back({});
  Evaluation(pair, lists, pairs, buffers, &found).findContacts();
  std::vector<NamedContact> out;
  for (const FeatureContact& c : found.close.witnessed())
    out.emplace_back(static_cast<int>(c.moving.kind), c.moving.index, static_cast<int>(c.fixed.kind), c.fixed.index, c.gap);
  std::sort(out.begin(), out.end());
  return out;
}

using NamedCrossing = std::tuple<Side, int, int>;

std::vector<NamedCrossing> crossingsOf(const MeshPair& pair, CandidateLists* lists, EvaluationBuffers* buffers) {
  EvaluatedContacts found;
  buffers->turned.turnForCrossings(*lists, pair.X_FM);
  Evaluation(pair, lists, lists->pairs, buffers, &found).findCrossings();
  std::vector<NamedCrossing> out;
  for (const Crossing& c : found.crossings) out.emplace_back(c.edge_side, c.edge, c.face);
  std::sort(out.begin(), out.end());
  return out;
}

/** A pose in which some vertex of one mesh is within `distance` [m] of some vertex of the other. */
Pose someMeeting(geometry::RandomShapes& random, const Shape& a, const Shape& b, double distance) {
  Pose X = random.pose(1);
  const auto someVertex = [&](const Shape& shape) {
    const std::vector<Vector3>& vertices = shape.collider.geometry->mesh().vertices;
    return vertices[random.integer(0, vertices.size() - 1)];
  };
  X.translation() += someVertex(b) + random.point(distance) - X * someVertex(a);
  return X;
}

/** The pose moved and turned within half the margin each. */
Pose movedALittle(geometry::RandomShapes& random, const Pose& X, const ListMargin& margin) {
  const Vector3 turn = random.point(1).normalized() * random.uniform(0, 0.5 * margin.motion / SIZE);
  return makePose(random.point(1).normalized() * random.uniform(0, 0.5 * margin.motion)) * X * makePose(Vector3::Zero(), turn);
}

TEST(CandidateCompleteness, ListsHoldEveryContact) {
  const std::vector<Shape> shapes = makeShapes();
  geometry::RandomShapes random(12);
  CandidateSearchBuffers buffers;
  EvaluationBuffers evaluation(&buffers.surroundings);
  CandidateListing listing;
  CandidatePairs nearest;
  std::size_t contacts = 0;
  for (int i = 0; i < samples(120); ++i) {
    const Shape &a = shapes[random.integer(0, shapes.size() - 1)], &b = shapes[random.integer(0, shapes.size() - 1)];
    SCOPED_TRACE(a.name + " at " + b.name + ", pose " + std::to_string(i));
    const Pose X = someMeeting(random, a, b, 1.5 * LAYER);
    const double part = i % 4 == 0 ? 0 : std::pow(10, random.uniform(-3, -0.5));
    const ListMargin margin{part * LAYER, part * LAYER / SIZE};
    findCandidates(pairOf(a.collider, b.collider, X), CandidateKind::CONTACTS, margin, &buffers, &listing);
    CandidateLists all = everything(pairOf(a.collider, b.collider, X), &evaluation.surroundings);
    for (int move = 0; move < 3; ++move) {
      const MeshPair pair = pairOf(a.collider, b.collider, movedALittle(random, X, margin));
      const std::vector<NamedContact> expected = contactsOf(pair, &all, all.pairs, &evaluation);
      ASSERT_EQ(contactsOf(pair, &listing.lists, listing.lists.pairs, &evaluation), expected);
      findNearest(pair, {listing.lists, evaluation.turned}, {0.2 * margin.motion, 0.2 * margin.turn}, &evaluation.surroundings, &nearest);
      ASSERT_EQ(contactsOf(pair, &listing.lists, nearest, &evaluation), expected);
      contacts += expected.size();
    }
  }
  RecordProperty("contacts", static_cast<int>(contacts));
  EXPECT_GT(contacts, samples(6000));
}

TEST(CandidateCompleteness, NearestHoldEveryContact) {
  const std::vector<Shape> shapes = makeShapes();
  geometry::RandomShapes random(15);
  SurroundingsMemory surroundings;
  EvaluationBuffers evaluation(&surroundings);
  CandidatePairs nearest;
  std::size_t contacts = 0, leading = 0;
  for (int i = 0; i < samples(60); ++i) {
    const Shape &a = shapes[random.integer(0, shapes.size() - 1)], &b = shapes[random.integer(0, shapes.size() - 1)];
    SCOPED_TRACE(a.name + " at " + b.name + ", pose " + std::to_string(i));
    const Pose X = someMeeting(random, a, b, 1.5 * LAYER);
    const double part = std::pow(10, random.uniform(-3, -1));
    const ListMargin margin{part * LAYER, part * LAYER / SIZE};
    const MeshPair pair = pairOf(a.collider, b.collider, X);
    CandidateLists all = everything(pair, &evaluation.surroundings);
    evaluation.turned.turnForContacts(all, X);
    leading += findNearest(pair, {all, evaluation.turned}, margin, &evaluation.surroundings, &nearest) - nearest.contacts();
    for (int move = 0; move < 4; ++move) {
      const MeshPair moved = pairOf(a.collider, b.collider, movedALittle(random, X, margin));
      const std::vector<NamedContact> expected = contactsOf(moved, &all, all.pairs, &evaluation);
      ASSERT_EQ(contactsOf(moved, &all, nearest, &evaluation), expected);
      contacts += expected.size();
    }
  }
  EXPECT_GT(contacts, samples(4000));
  EXPECT_GT(leading, samples(4000));
}

TEST(CandidateCompleteness, ListsHoldEveryCrossing) {
  const std::vector<Shape> shapes = makeShapes();
  geometry::RandomShapes random(14);
  CandidateSearchBuffers buffers;
  EvaluationBuffers evaluation(&buffers.surroundings);
  CandidateListing listing;
  std::size_t crossings = 0, poses = 0;
  for (int i = 0; i < samples(120); ++i) {
    const Shape &a = shapes[random.integer(0, shapes.size() - 1)], &b = shapes[random.integer(0, shapes.size() - 1)];
    SCOPED_TRACE(a.name + " at " + b.name + ", pose " + std::to_string(i));
    const Pose X = someMeeting(random, a, b, 0.1 * LAYER);
    const MeshPair pair = pairOf(a.collider, b.collider, X);
    // The mesh slides along, and turns about some axis through its middle, not at all or as fast.
    const double step = LAYER * std::pow(10, random.uniform(-4, -2)), steps = 10;
    const Vector3 shift = step * random.point(1).normalized(), turn = (i % 2) * step / SIZE * random.point(1).normalized();
    const auto after = [&](double count) { return makePose(count * shift) * X * makePose(Vector3::Zero(), count * turn); };
    const ListMargin margin = marginAlong(NearRegion(pair).motions(X, after(-1)), steps, 0.01 * step);
    findCandidates(pair, CandidateKind::CROSSINGS, margin, &buffers, &listing);
    CandidateLists all = everything(pair, &evaluation.surroundings);
    for (int move = 0; move < 4; ++move) {
      const Pose Y = makePose(random.point(0.04 * steps * step)) * after(random.uniform(-steps, steps));
      const MeshPair moved = pairOf(a.collider, b.collider, Y);
      if (NearRegion(moved).used(listing.origin, Y, LAYER) > 1) continue;
      const std::vector<NamedCrossing> expected = crossingsOf(moved, &all, &evaluation);
      ASSERT_EQ(crossingsOf(moved, &listing.lists, &evaluation), expected);
      crossings += expected.size();
      ++poses;
    }
  }
  EXPECT_GT(crossings, samples(2000));
  EXPECT_GT(poses, samples(240));
}

// A large mesh in a frame far away, a small one that is looked at in its own: coordinates are rounded as the larger ones are.
TEST(CandidateCompleteness, LargeMovingMeshesAreRoundedAsSuch) {
  geometry::RandomShapes random(13);
  const Collider ball = makeCollider(geometry::icosphereMesh(0.05, 2), 0.5 * LAYER),
                 large = makeCollider(geometry::boxMesh({4, 4, 4}), 0.5 * LAYER);
  CandidateSearchBuffers buffers;
  CandidateListing listing;
  for (int i = 0; i < samples(300); ++i) {
    // The ball's lowest vertex, at a height just within the layer over some place of the box's upper face.
    const Pose X_BM = random.pose(1);
    const std::vector<Vector3>& vertices = ball.geometry->mesh().vertices;
    const Vector3 up = X_BM.linear().col(2);
    const Vector3& lowest =
        *std::min_element(vertices.begin(), vertices.end(), [&](const Vector3& p, const Vector3& q) { return p.dot(up) < q.dot(up); });
    const Vector3 place(random.uniform(-1.9, 1.9), random.uniform(-1.9, 1.9), 2 + LAYER - 1e-9);
    Pose X_FM = X_BM;
    X_FM.translation() = lowest - X_FM.linear() * place;
    findCandidates(pairOf(large, ball, X_FM), CandidateKind::CONTACTS, {}, &buffers, &listing);
    ASSERT_FALSE(listing.lists.pairs.vertex_face.fixed.empty()) << i;
  }
}

}  // namespace
}  // namespace blem_sim::contact
