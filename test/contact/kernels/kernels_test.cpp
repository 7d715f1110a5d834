// Every instruction set gives the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "blem_sim/geometry/input_error.h"
#include "evaluation/world_contact.h"
#include "geometry/random_shapes.h"
#include "kernels/kernels.h"
#include "kernels/vectors.h"

namespace blem_sim::contact {
namespace {

using namespace kernels;

constexpr std::uint32_t FEATURES = 61, CANDIDATES = 997;  // no whole number of vectors
constexpr std::uint32_t RUN = 20;
constexpr double RANGE = 0.3;

struct Features {
  std::vector<Vec4> vertices;
  std::vector<int> names;  // as the vertices and the faces
  std::vector<EdgeRecord> edges;
  std::vector<FaceRecord> faces;
  std::vector<OpenSides> open;
  std::vector<Candidate> candidates;
};

Features randomFeatures() {
  geometry::RandomShapes random(17);
  Features out;
  for (std::uint32_t i = 0; i < FEATURES; ++i) {
    const geometry::Triangle t = random.triangle(1);
    const Vector3 along = t[1] - t[0], normal = along.cross(t[2] - t[0]).normalized();
    out.names.push_back(static_cast<int>(1000 + i));
    out.vertices.push_back(vec4(random.point(1), nameBits(out.names.back())));
    const auto inward = [&](double sign) { return vec4(sign * (normal + random.point(3)).cross(along).normalized(), 0); };
    out.edges.push_back({vec4(t[0], along.squaredNorm()), vec4(along, i % 7 == 0), {inward(1), inward(-1)}});
    FaceRecord face;
    face.plane = vec4(normal, normal.dot(t[0]));
    for (int k = 0; k < 3; ++k) {
      const Vector3 side = normal.cross(t[(k + 1) % 3] - t[k]).normalized();
      face.sides[k] = vec4(side, side.dot(t[k]));
    }
    out.faces.push_back(face);
    out.open.push_back(random.integer(0, 63));
  }
  const auto any = [&] { return static_cast<std::uint32_t>(random.integer(0, FEATURES - 1)); };
  // Every other run is of one feature b, as vertices over a large face are.
  for (std::uint32_t i = 0; i < CANDIDATES; ++i) {
    const std::uint32_t run = i / RUN;
    out.candidates.push_back({any(), run % 2 ? any() : run % FEATURES});
  }
  return out;
}

CandidateRun runOf(const Features& in) { return {in.candidates.data(), static_cast<std::uint32_t>(in.candidates.size())}; }

/** Vertices and faces as one set finds them, the features being those of either mesh. */
struct PlainVertexFaces {
  PlainVertexFaces(const Kernels& set, const Features& in, Side side, bool takes_plain, const std::vector<std::uint8_t>& inner = {},
                   const Pose& X_FM = makePose({0.1, -0.2, 0.3}, {0.4, 0.5, -0.6}))
      : X_FM(X_FM),
        vertices{in.vertices.data(), side, motionOf(X_FM.inverse()), motionOf(X_FM)},
        X_WF(makePose({-3, 2, 1}, {0.7, -0.2, 0.1})),
        hits(CANDIDATES + 1),
        rows(CANDIDATES + 1) {
    const Feature vertex{FeatureKind::VERTEX, 0}, face{FeatureKind::FACE, 0};
    // The vertices are A's.
    plain = {{in.names.data(), side, side, motionOf(X_FM), motionOf(X_WF), RADIUS_A + RADIUS_B, 0.5 * (RADIUS_B - RADIUS_A),
              contactId(vertex, face), false},
             rows.data(),
             0,
             -1};
    hits.resize(set.vertexFaces({vertices, in.faces.data(), in.open.data()}, {runOf(in), inner.empty() ? nullptr : inner.data()}, RANGE,
                                takes_plain ? &plain : nullptr, hits.data()));
  }

  static constexpr double RADIUS_A = 0.2, RADIUS_B = 0.1;
  Pose X_FM;
  NearVertices vertices;
  Pose X_WF;
  std::vector<VertexFaceHit> hits;
  std::vector<ContactNumbers> rows;
  PlainContacts plain;
};

/** Results of one instruction set, as bytes. */
struct Found {
  std::vector<std::uint32_t> counts, indices;
  std::vector<double> numbers;
};

void addPlainVertexFaces(const Kernels& set, const Features& in, Side side, Found* out) {
  const PlainVertexFaces found(set, in, side, true);
  out->counts.insert(out->counts.end(), {found.plain.count, static_cast<std::uint32_t>(found.hits.size())});
  for (const VertexFaceHit& hit : found.hits) {
    out->indices.insert(out->indices.end(), {hit.candidate, hit.bits});
    out->numbers.push_back(hit.height);
  }
  for (std::uint32_t i = 0; i < found.plain.count; ++i) {
    const ContactNumbers& row = found.rows[i];
    out->numbers.insert(out->numbers.end(), row.point, row.point + 3);
    out->numbers.insert(out->numbers.end(), row.normal, row.normal + 3);
    out->numbers.push_back(row.depth);
    out->indices.insert(out->indices.end(), {static_cast<std::uint32_t>(row.id >> 32), static_cast<std::uint32_t>(row.id)});
  }
}

Found found(const Kernels& set, const Features& in) {
  Found out;
  const auto add = [&](std::uint32_t count) { out.counts.push_back(count); };
  const CandidateRun candidates = runOf(in);
  for (const Side side : SIDES) addPlainVertexFaces(set, in, side, &out);
  std::vector<std::uint32_t> hits(CANDIDATES);
  const auto addHits = [&](std::uint32_t count) {
    add(count);
    out.indices.insert(out.indices.end(), hits.begin(), hits.begin() + count);
  };
  std::vector<VertexEdgeHit> vertex_edges(CANDIDATES);
  add(set.vertexEdges(in.vertices.data(), in.edges.data(), candidates, 3 * RANGE, vertex_edges.data()));
  for (std::uint32_t i = 0; i < out.counts.back(); ++i) {
    out.indices.push_back(vertex_edges[i].candidate);
    out.numbers.insert(out.numbers.end(), vertex_edges[i].offset, vertex_edges[i].offset + 3);
  }
  addHits(set.vertexVertices(in.vertices.data(), in.vertices.data(), candidates, RANGE, hits.data()));
  addHits(set.edgeFaces(in.edges.data(), in.faces.data(), candidates, hits.data()));
  std::vector<Candidate> near(CANDIDATES);
  const auto addNear = [&](std::uint32_t count) {
    add(count);
    for (std::uint32_t i = 0; i < count; ++i) out.indices.insert(out.indices.end(), {near[i].first, near[i].second});
  };
  const Reach reach{RANGE, 0.1, 0.02};
  std::vector<std::uint8_t> inner(CANDIDATES);
  for (const Side side : SIDES) {
    const Motion X_MF = motionOf(makePose({0.1, -0.2, 0.3}, {0.4, 0.5, -0.6}));
    const NearVertices vertices{in.vertices.data(), side, X_MF, X_MF};
    addNear(set.nearVertexFaces({vertices, in.faces.data(), in.open.data()}, candidates, reach, near.data(), inner.data()));
    out.indices.insert(out.indices.end(), inner.begin(), inner.begin() + out.counts.back());
  }
  addNear(set.nearEdgeEdges(in.edges.data(), in.edges.data(), candidates, reach, near.data()));
  addNear(set.nearVertexEdges(in.vertices.data(), in.edges.data(), candidates, reach, near.data()));
  addNear(set.nearVertexVertices(in.vertices.data(), in.vertices.data(), candidates, reach, near.data()));
  const Motion motion = motionOf(makePose({0.1, -0.2, 0.3}, {0.4, 0.5, -0.6}));
  std::vector<EdgeRecord> turned(FEATURES);
  set.turnEdges(in.edges.data(), FEATURES, motion, turned.data());
  for (const EdgeRecord& edge : turned)
    for (const Vec4& v : {edge.start, edge.along, edge.inward[0], edge.inward[1]})
      out.numbers.insert(out.numbers.end(), {v.x, v.y, v.z, v.w});
  std::vector<FaceRecord> turned_faces(FEATURES);
  set.turnFaces(in.faces.data(), FEATURES, motion, turned_faces.data());
  for (const FaceRecord& face : turned_faces)
    for (const Vec4& v : {face.plane, face.sides[0], face.sides[1], face.sides[2]})
      out.numbers.insert(out.numbers.end(), {v.x, v.y, v.z, v.w});
  return out;
}

TEST(Kernels, AllInstructionSetsFindTheSame) {
  const Features features = randomFeatures();
  const Found baseline = found(*availableKernels().back(), features);
  for (const std::uint32_t count : baseline.counts) EXPECT_GT(count, 5u);
  for (const Kernels* set : availableKernels()) {
    SCOPED_TRACE(set->name);
    const Found each = found(*set, features);
    EXPECT_EQ(each.counts, baseline.counts);
    EXPECT_EQ(each.indices, baseline.indices);
    ASSERT_EQ(each.numbers.size(), baseline.numbers.size());
    EXPECT_EQ(std::memcmp(each.numbers.data(), baseline.numbers.data(), sizeof(double) * each.numbers.size()), 0);
  }
}

TEST(Kernels, PlainContactsAreThoseMadeOneByOne) {
  const Features in = randomFeatures();
  for (const Side side : SIDES) {
    SCOPED_TRACE(static_cast<int>(side));
    const PlainVertexFaces written(*availableKernels().front(), in, side, true), all(*availableKernels().front(), in, side, false);
    std::uint32_t count = 0, close = 0;
    double deepest = -1;
    for (const VertexFaceHit& hit : all.hits) {
      if (!hit.has(VertexFaceHit::PLAIN) || hit.has(VertexFaceHit::NEAR_BORDER)) {
        ++close;
        continue;
      }
      const Candidate& c = in.candidates[hit.candidate];
      const Vector3 p = vector3(in.vertices[c.first]), plane = vector3(in.faces[c.second].plane),
                    up = side == Side::FIXED ? Vector3(all.X_FM.linear() * plane) : plane;
      // The normal points from the faces' mesh, which is B, to the vertices'.
      const ContactRoles roles{Side::MOVING, {all.RADIUS_A, all.RADIUS_B}};
      Contact one = contactOf(roles, {{FeatureKind::VERTEX, in.names[c.first]},
                                      {FeatureKind::FACE, in.names[c.second]},
                                      p,
                                      p - hit.height * up,
                                      hit.height > 0 ? up : Vector3(-up),
                                      std::abs(hit.height)});
      one.point = all.X_WF * one.point;
      one.normal_BA = all.X_WF.linear() * one.normal_BA;
      ASSERT_LT(count, written.plain.count);
      const ContactNumbers& row = written.rows[count];
      deepest = std::max(deepest, one.depth);
      EXPECT_EQ(row.id, one.id);
      EXPECT_EQ(row.depth, one.depth);
      EXPECT_EQ(row.weight, one.weight);
      EXPECT_EQ(row.pierced, 0u);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(row.point[k], one.point[k], 1e-15);
        EXPECT_EQ(row.normal[k], one.normal_BA[k]);
      }
      ++count;
    }
    EXPECT_EQ(count, written.plain.count);
    EXPECT_EQ(written.plain.deepest, deepest);
    EXPECT_GT(count, 5u);
    EXPECT_EQ(close, written.hits.size());
  }
}

/** Keeps the candidates that can have a contact, the flagged ones first. @return their flags */
std::vector<std::uint8_t> sortByFlags(const NearVertices& vertices, const Reach& reach, Features* features) {
  const Kernels& set = *availableKernels().front();
  std::vector<Candidate> near(CANDIDATES);
  std::vector<std::uint8_t> inner(CANDIDATES);
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<Candidate>& all = features->candidates;
    const std::uint32_t count =
        set.nearVertexFaces({vertices, features->faces.data(), features->open.data()}, runOf(*features), reach, near.data(), inner.data());
    inner.resize(count);
    all.clear();
    for (const int flag : {1, 0})
      for (std::uint32_t i = 0; i < count; ++i)
        if (inner[i] == flag) all.push_back(near[i]);
  }
  return inner;
}

TEST(Kernels, VerticesThatAreSurelyInsideNeedNoTest) {
  constexpr double MARGIN = 0.02;
  const Pose X_FM = makePose({0.1, -0.2, 0.3}, {0.4, 0.5, -0.6});
  for (const Side side : SIDES) {
    SCOPED_TRACE(static_cast<int>(side));
    Features in = randomFeatures();
    const NearVertices vertices{in.vertices.data(), side, motionOf(X_FM.inverse()), motionOf(X_FM)};
    const std::vector<std::uint8_t> inner = sortByFlags(vertices, {RANGE, MARGIN, 0}, &in);
    const auto flagged = std::count(inner.begin(), inner.end(), 1);
    EXPECT_TRUE(std::is_sorted(inner.rbegin(), inner.rend()));
    ASSERT_GE(flagged, 24);
    ASSERT_LT(flagged + 8u, inner.size());
    geometry::RandomShapes random(3);
    for (int i = 0; i < 20; ++i) {
      const Pose moved = Eigen::Translation3d(0.999 * MARGIN * random.point(1).normalized()) * X_FM;
      const PlainVertexFaces with(*availableKernels().front(), in, side, true, inner, moved),
          without(*availableKernels().front(), in, side, true, {}, moved);
      ASSERT_EQ(with.plain.count, without.plain.count);
      EXPECT_GT(with.plain.count, 10u);
      EXPECT_EQ(std::memcmp(with.rows.data(), without.rows.data(), with.plain.count * sizeof(ContactNumbers)), 0);
      EXPECT_EQ(with.hits.size(), without.hits.size());
      EXPECT_EQ(with.plain.deepest, without.plain.deepest);
    }
  }
}

LeafShapes randomLeaf(std::uint64_t seed) {
  geometry::RandomShapes random(seed);
  LeafShapes leaf{};
  leaf.face_count = 8;
  leaf.edge_count = 19;
  leaf.vertex_count = 7;
  const auto fill = [&](float* from, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) from[i] = static_cast<float>(random.uniform(-1, 1));
  };
  const auto fillRows = [&](auto& rows) { fill(reinterpret_cast<float*>(&rows), sizeof rows / sizeof(float)); };
  fillRows(leaf.faces.planes);
  leaf.edge_cone = {{0, 0.6f, 0.8f}, 0.54f, 0.84f};
  for (OpenSides& open : leaf.faces.open) open = random.integer(0, 63);
  fillRows(leaf.faces.sides);
  for (LeafEdges& edges : leaf.edges) {
    fillRows(edges.starts);
    fillRows(edges.inwards);
    fillRows(edges.directions);
    std::fill_n(edges.lengths, LEAF_BLOCK, 0.8f);
    fillRows(edges.folds);
  }
  for (LeafVertices& vertices : leaf.vertices) fillRows(vertices.points);
  for (LeafCones& cones : leaf.cones) {
    fillRows(cones.axes);
    fillRows(cones.up);
    fillRows(cones.down);
    std::fill_n(cones.per_slack, LEAF_BLOCK, 1.5f);
    for (std::int32_t& round : cones.round) round = -random.integer(0, 1);
  }
  std::fill_n(leaf.halves, 3, 1.0f);
  leaf.region = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, {1, 1, 1}, 0.6f, 0.5f, 1.3f};
  leaf.nearest = 0x7F;
  return leaf;
}

std::vector<std::uint32_t> leafHits(const Kernels& set, const LeafShapes& a, const LeafShapes& b) {
  LeafShapes turned = a;
  set.turnLeaf(a, motionOf(makePose({0.01, 0.02, -0.03}, {0.1, 0.2, 0.3})), &turned);
  const LeafReach reach{0.5f, 0.1f, 0.02f, 0.2f, 1e-6f, 0, {{0.06f, 0.08f, 0}, {-0.04f, 0.03f, 0}, {0, 0, 0.01f}}};
  LeafHits hits;
  set.leafContacts(turned, b, reach, &hits);
  set.leafCrossings(turned, b, reach, &hits);
  std::vector<std::uint32_t> out;
  const auto add = [&out](const LeafHit* from, int count) {
    out.push_back(count);
    for (int i = 0; i < count; ++i) out.insert(out.end(), {from[i].feature, from[i].bits});
  };
  add(hits.vertex_vertex, hits.vertex_vertices);
  add(hits.edge_edge, hits.edge_edges);
  for (const Side side : SIDES) {
    add(hits.vertex_face[side], hits.vertex_faces[side]);
    add(hits.vertex_edge[side], hits.vertex_edges[side]);
    add(hits.edge_face[side], hits.edge_faces[side]);
  }
  return out;
}

TEST(Kernels, AllInstructionSetsListTheSameCandidates) {
  for (int i = 0; i < 20; ++i) {
    const LeafShapes a = randomLeaf(2 * i), b = randomLeaf(2 * i + 1);
    const std::vector<std::uint32_t> baseline = leafHits(*availableKernels().back(), a, b);
    EXPECT_GT(baseline.size(), 30u);
    for (const Kernels* set : availableKernels()) EXPECT_EQ(leafHits(*set, a, b), baseline) << set->name;
  }
}

TEST(Kernels, AreChosenByName) {
  EXPECT_EQ(&kernelsNamed(nullptr), availableKernels().front());
  EXPECT_STREQ(kernelsNamed("baseline").name, "baseline");
  EXPECT_THROW(kernelsNamed("avx1024"), InputError);
}

}  // namespace
}  // namespace blem_sim::contact
