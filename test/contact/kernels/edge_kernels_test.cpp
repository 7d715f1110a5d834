// Edges near edges: the kernels write the contacts that stand, and find where those that fade are, with every instruction set the same
// ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "evaluation/world_contact.h"
#include "features/edge_pair.h"
#include "geometry/random_shapes.h"
#include "kernels/kernels.h"
#include "kernels/vectors.h"

namespace blem_sim::contact {
namespace {

using namespace kernels;

constexpr std::uint32_t EDGES = 127, EDGE_PAIRS = EDGES * EDGES;  // no whole number of vectors
constexpr double EDGE_RANGE = 0.3, EDGE_RADIUS_A = 0.2, EDGE_RADIUS_B = 0.1;

struct EdgesNearEdges {
  EdgesNearEdges() : X_WF(makePose({-3, 2, 1}, {0.7, -0.2, 0.1})) {
    geometry::RandomShapes random(29);
    for (std::uint32_t i = 0; i < EDGES; ++i) {
      const geometry::Triangle t = random.triangle(1);
      const Vector3 along = t[1] - t[0];
      const auto inward = [&](int k) { return vec4(random.point(3).cross(along).normalized(), nameBits(vertexAt(i, k))); };
      records.push_back({vec4(t[0], along.squaredNorm()), vec4(along, i % 7 == 0), {inward(0), inward(1)}});
      names.push_back(static_cast<int>(1000 + i));
    }

    for (std::uint32_t i = 0; i < EDGE_PAIRS; ++i) candidates.push_back({i / EDGES, i % EDGES});
  }

  /** @param end -1: none */
  static int vertexAt(std::uint32_t edge, int end) { return end < 0 ? -1 : static_cast<int>(3000 + 2 * edge) + end; }

  static ContactRoles roles(Side a) {
    ContactRoles roles{a, {}};
    roles.radius[a] = EDGE_RADIUS_A;
    roles.radius[!a] = EDGE_RADIUS_B;
    return roles;
  }
  EdgePlace place(Side a) const {
    const Feature edge{FeatureKind::EDGE, 0};
    return {names.data(),         names.data(), a, motionOf(X_WF), EDGE_RADIUS_A + EDGE_RADIUS_B, 0.5 * (EDGE_RADIUS_B - EDGE_RADIUS_A),
            contactId(edge, edge)};
  }

  Pose X_WF;
  std::vector<EdgeRecord> records;
  std::vector<int> names;
  std::vector<Candidate> candidates;
};

/** Contacts that one instruction set finds. */
struct FoundEdges {
  FoundEdges(const Kernels& set, const EdgesNearEdges& in, Side a, bool takes_plain)
      : hits(EDGE_PAIRS + 1), left(EDGE_PAIRS + 1), fading(EDGE_PAIRS + 1), rows(EDGE_PAIRS + 1), plain{in.place(a), rows.data(), 0, -1} {
    const EdgeRecord* const records = in.records.data();
    const CandidateRun run{in.candidates.data(), EDGE_PAIRS};
    LeftEdges to_left{left.data(), 0};
    hits.resize(set.edgeEdges(records, records, run, EDGE_RANGE, {takes_plain ? &plain : nullptr, &to_left, hits.data()}));
    left.resize(to_left.count);
    rows.resize(plain.count);
    fading.resize(set.fadingEdges(records, records, run, EDGE_RANGE, fading.data()));
  }
  std::vector<EdgeEdgeHit> hits;
  std::vector<Candidate> left;
  std::vector<FadingEdgesHit> fading;
  std::vector<ContactNumbers> rows;
  PlainEdges plain;
};

template <typename Hit>
Vector3 alongOf(const EdgesNearEdges& in, const Hit& hit, bool first) {
  const Candidate& c = in.candidates[hit.candidate];
  return vector3(in.records[first ? c.first : c.second].along);
}

TEST(EdgeKernels, PlainContactsAreThoseMadeOneByOne) {
  const EdgesNearEdges in;
  for (const Side a : SIDES) {
    const FoundEdges written(*availableKernels().front(), in, a, true), all(*availableKernels().front(), in, a, false);
    std::uint32_t count = 0, close = 0;
    double deepest = -1;
    for (const EdgeEdgeHit& hit : all.hits) {
      const bool again = close < written.hits.size() && written.hits[close].candidate == hit.candidate;
      close += again;
      if (again) continue;
      const Candidate& c = in.candidates[hit.candidate];
      const Vector3 point_m(hit.point_m), point_f(hit.point_f), normal(hit.normal);
      EXPECT_NEAR((point_m - point_f - hit.gap * normal).norm(), 0, 1e-13);
      Contact one =
          contactOf(in.roles(a),
                    {{FeatureKind::EDGE, in.names[c.first]}, {FeatureKind::EDGE, in.names[c.second]}, point_m, point_f, normal, hit.gap});
      one.point = in.X_WF * one.point;
      one.normal_BA = in.X_WF.linear() * one.normal_BA;
      ASSERT_LT(count, written.rows.size());
      const ContactNumbers& row = written.rows[count++];
      deepest = std::max(deepest, one.depth);
      EXPECT_EQ(row.id, one.id);
      EXPECT_EQ(row.depth, one.depth);
      EXPECT_EQ(row.weight, one.weight);
      EXPECT_EQ(row.pierced, 0u);
      EXPECT_EQ(Vector3(row.point), one.point);
      EXPECT_EQ(Vector3(row.normal), one.normal_BA);
    }
    EXPECT_EQ(count, written.rows.size());
    EXPECT_EQ(close, written.hits.size());
    EXPECT_GT(all.left.size(), 5u);
    EXPECT_EQ(written.plain.deepest, deepest);
    EXPECT_GT(count, 5u);
  }
}

TEST(EdgeKernels, FadingContactsAreWhereTheEdgesAreClosest) {
  const EdgesNearEdges in;
  int beyond_one = 0, beyond_both = 0, inside = 0;
  for (const FadingEdgesHit& hit : FoundEdges(*availableKernels().front(), in, Side::MOVING, false).fading) {
    const Candidate& c = in.candidates[hit.candidate];
    const Vector3 p = vector3(in.records[c.first].start), q = vector3(in.records[c.second].start), along_p = alongOf(in, hit, true),
                  along_q = alongOf(in, hit, false);
    EdgePair feet;
    const bool is_inside = findEdgePair({p, p + along_p}, {q, q + along_q}, EDGE_RANGE, &feet);
    EXPECT_EQ(hit.is_inside, is_inside);
    inside += is_inside;
    if (is_inside) continue;
    const Vector3 point_a(hit.point_m), point_b(hit.point_f), normal(hit.normal);
    EXPECT_NEAR((point_a - point_b).norm(), hit.distance, 1e-13);
    EXPECT_NEAR(std::abs(normal.dot(along_p.normalized())) + std::abs(normal.dot(along_q.normalized())), 0, 1e-9);
    EXPECT_GE(normal.dot(p - q), 0);
    EXPECT_LE(hit.gap, EDGE_RANGE);
    // Distance beyond its end at which the other line passes.
    const Vector3 across = along_p.cross(along_q);
    const double s = (q - p).cross(along_q).dot(across) / across.squaredNorm(),
                 t = (q - p).cross(along_p).dot(across) / across.squaredNorm();
    const auto end = [](double part) { return part < 0 ? 0 : part > 1 ? 1 : -1; };
    const auto past = [](double part, const Vector3& along) { return std::max({-part, part - 1, 0.0}) * along.norm(); };
    EXPECT_EQ(hit.end_m, in.vertexAt(c.first, end(s)));
    EXPECT_EQ(hit.end_f, in.vertexAt(c.second, end(t)));
    EXPECT_NEAR(hit.gap - hit.distance, FADE_SLOPE * std::max(past(s, along_p), past(t, along_q)), 1e-9);
    const bool both = hit.end_m >= 0 && hit.end_f >= 0;
    (both ? beyond_both : beyond_one) += 1;
    if (both) continue;
    // No other point of either edge is closer to the other's point.
    for (double part = 0; part <= 1; part += 0.125)
      EXPECT_GE(std::min((p + part * along_p - point_b).norm(), (q + part * along_q - point_a).norm()), hit.distance - 1e-12);
    EXPECT_EQ(hit.cones_known, c.first % 7 != 0 && c.second % 7 != 0);
  }
  EXPECT_GT(beyond_one, 20);
  EXPECT_GT(beyond_both, 2);
  EXPECT_GT(inside, 20);
}

TEST(EdgeKernels, AllInstructionSetsFindTheSame) {
  const EdgesNearEdges in;
  const auto same = [](const double* a, const double* b, std::size_t count) { return std::memcmp(a, b, sizeof(double) * count) == 0; };
  for (const bool takes_plain : {false, true}) {
    const FoundEdges baseline(*availableKernels().back(), in, Side::MOVING, takes_plain);
    for (const Kernels* set : availableKernels()) {
      SCOPED_TRACE(set->name);
      const FoundEdges each(*set, in, Side::MOVING, takes_plain);
      ASSERT_EQ(each.hits.size(), baseline.hits.size());
      for (std::size_t i = 0; i < each.hits.size(); ++i) {
        const EdgeEdgeHit &a = each.hits[i], &b = baseline.hits[i];
        EXPECT_EQ(a.candidate, b.candidate);
        EXPECT_TRUE(same(a.point_m, b.point_m, 3) && same(a.point_f, b.point_f, 3) && same(a.normal, b.normal, 3) && a.gap == b.gap);
      }
      ASSERT_EQ(each.left.size(), baseline.left.size());
      EXPECT_EQ(std::memcmp(each.left.data(), baseline.left.data(), sizeof(Candidate) * each.left.size()), 0);
      ASSERT_EQ(each.rows.size(), baseline.rows.size());
      for (std::size_t i = 0; i < each.rows.size(); ++i) EXPECT_TRUE(same(each.rows[i].point, baseline.rows[i].point, 10));
      EXPECT_EQ(each.plain.deepest, baseline.plain.deepest);
      ASSERT_EQ(each.fading.size(), baseline.fading.size());
      for (std::size_t i = 0; i < each.fading.size(); ++i) {
        const FadingEdgesHit &a = each.fading[i], &b = baseline.fading[i];
        EXPECT_EQ(a.candidate, b.candidate);
        EXPECT_EQ(a.is_inside, b.is_inside);
        EXPECT_EQ(a.cones_known, b.cones_known);
        EXPECT_EQ(a.end_m, b.end_m);
        EXPECT_EQ(a.end_f, b.end_f);
        EXPECT_TRUE(a.is_inside || (same(a.point_m, b.point_m, 8) && same(a.normal, b.normal, 3)));
      }
    }
  }
}

TEST(EdgeKernels, EdgesAroundAVertexLeadAsTheirDirectionsSay) {
  geometry::RandomShapes random(37);
  constexpr double NEAR = 0.01;
  int downs = 0, nears = 0, towards = 0;
  for (int i = 0; i < 600; ++i) {
    const int count = i % 20;
    std::vector<EdgeDirections> blocks(directionBlocks(count), EdgeDirections{});
    const Vector3 down = random.point(1).normalized(), aside = down.cross(random.point(1)).normalized();
    LeadingEdges expected{false, false};
    const double least = random.uniform(0, 0.9);
    bool leads = false;
    for (int k = 0; k < count; ++k) {
      // Few directions lead down, some of them hardly.
      Vector3 direction = random.point(1).normalized();
      if (direction.dot(down) > 0) direction -= random.uniform(0.9, 1.5) * direction.dot(down) * down;
      direction.normalize();
      const bool is_flat = random.integer(0, 3) == 0;
      EdgeDirections& block = blocks[k / DIRECTION_BLOCK];
      const int lane = k % DIRECTION_BLOCK;
      block.x[lane] = direction.x(), block.y[lane] = direction.y(), block.z[lane] = direction.z();
      block.near[lane] = is_flat ? -1 : NEAR;
      const double sine = direction.dot(down), beside = direction.dot(aside);
      expected.down = expected.down || sine > CONE_SLACK;
      expected.near = expected.near || (sine > CONE_SLACK && !is_flat && sine <= NEAR * (sine * sine + beside * beside));
      leads = leads || direction.dot(aside) > least;
    }
    downs += expected.down, nears += expected.near, towards += leads;
    for (const Kernels* set : availableKernels()) {
      SCOPED_TRACE(set->name);
      const LeadingEdges found = set->leadingEdges(blocks.data(), static_cast<int>(blocks.size()), down.data(), aside.data());
      EXPECT_EQ(found.down, expected.down);
      EXPECT_EQ(found.near, expected.near);
      EXPECT_EQ(set->leadTo(blocks.data(), static_cast<int>(blocks.size()), aside.data(), least * least), leads);
    }
  }
  for (const int often : {downs, nears, towards}) {
    EXPECT_GT(often, 20);
    EXPECT_LT(often, 580);
  }
}

}  // namespace
}  // namespace blem_sim::contact
