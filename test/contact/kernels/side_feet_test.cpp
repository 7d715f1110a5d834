// Vertices beside faces: the kernels find the closest points of the faces' sides, with every instruction set the same ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "evaluation/world_contact.h"
#include "features/tolerances.h"
#include "geometry/random_shapes.h"
#include "kernels/kernels.h"
#include "kernels/vectors.h"

namespace blem_sim::contact {
namespace {

using namespace kernels;

constexpr std::uint32_t COUNT = 61;  // no whole number of vectors
constexpr double RADIUS_A = 0.2, RADIUS_B = 0.1;

constexpr double FEET_RANGE = 1.2;

/** A vertex beside some sides of a face each. */
struct SidesAndVertices {
  explicit SidesAndVertices(Side vertices)
      : vertices(vertices), X_FM(makePose({0.1, -0.2, 0.3}, {0.4, 0.5, -0.6})), X_WF(makePose({-3, 2, 1}, {0.7, -0.2, 0.1})) {
    geometry::RandomShapes random(23);
    for (std::uint32_t i = 0; i < COUNT; ++i) {
      const geometry::Triangle t = random.triangle(1);
      const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized(), p = random.point(1);
      placed.push_back(vec4(vertices == Side::FIXED ? Vector3(X_FM * p) : p, nameBits(i)));
      faces.push_back({vec4(normal, normal.dot(t[0])), {}});
      corners.push_back({{vec4(t[0], 0), vec4(t[1], 0), vec4(t[2], 0)}});
      sides.push_back({static_cast<std::uint32_t>(random.integer(1, 7)), i, random.uniform(0, 0.5)});
      patches.push_back(static_cast<int>(7 * i));
      pairs.push_back({i, i});
    }
  }

  ContactPlace place(bool keeps_feet) const {
    // The vertices are A's.
    return {patches.data(),
            vertices,
            vertices,
            motionOf(X_FM),
            motionOf(X_WF),
            RADIUS_A + RADIUS_B,
            0.5 * (RADIUS_B - RADIUS_A),
            contactId({FeatureKind::VERTEX, 0}, {FeatureKind::FACE, 0}),
            keeps_feet};
  }

  Side vertices;
  Pose X_FM, X_WF;
  std::vector<Vec4> placed;  // vertices in frame F
  std::vector<FaceRecord> faces;
  std::vector<FaceCorners> corners;
  std::vector<BesideSides> sides;
  std::vector<int> patches;
  std::vector<Candidate> pairs;
};

/** Feet that an instruction set finds. */
struct Feet {
  Feet(const Kernels& set, const SidesAndVertices& in, bool keeps_feet) : rows(COUNT + 1), asked(COUNT) {
    FadingContacts out{rows.data(), asked.data(), 0};
    const VerticesBesideFaces features{{in.placed.data(), in.vertices, motionOf(in.X_FM.inverse()), motionOf(in.X_FM)},
                                       in.faces.data(),
                                       in.corners.data(),
                                       in.sides.data()};
    count = set.sideFeet(in.place(keeps_feet), features, {in.pairs.data(), COUNT}, FEET_RANGE, &out);
    rows.resize(count);
    asked.resize(out.asked_count);
  }

  std::vector<ContactNumbers> rows;
  std::vector<FadingContact> asked;
  std::uint32_t count;
};

TEST(SideFeet, AreTheClosestPointsOfTheNearestSides) {
  for (const Side vertices : SIDES) {
    const SidesAndVertices in(vertices);
    const Feet feet(*availableKernels().front(), in, true), contacts(*availableKernels().front(), in, false);
    std::uint32_t found = 0, ends = 0;
    std::uint32_t within = 0;
    for (std::uint32_t i = 0; i < COUNT; ++i) {
      const Vector3 placed = vector3(in.placed[i]), p = vertices == Side::FIXED ? Vector3(in.X_FM.inverse() * placed) : placed,
                    normal = vector3(in.faces[i].plane), projection = p - (normal.dot(p) - in.faces[i].plane.w) * normal;
      double beside = 1e9, part = 0;
      Vector3 foot = Vector3::Zero();
      for (int k = 0; k < 3; ++k) {
        if ((in.sides[i].outside >> k & 1) == 0) continue;
        const Vector3 start = vector3(in.corners[i].of[k]), along = vector3(in.corners[i].of[(k + 1) % 3]) - start;
        const double part_k = std::clamp((projection - start).dot(along) / along.squaredNorm(), 0.0, 1.0);
        const Vector3 foot_k = start + part_k * along;
        if ((projection - foot_k).norm() >= beside) continue;
        beside = (projection - foot_k).norm();
        part = part_k;
        foot = foot_k;
      }
      const double gap = (p - foot).norm() + FADE_SLOPE * beside;
      if (gap > FEET_RANGE) continue;
      ends += part == 0 || part == 1;
      if (beside <= in.sides[i].reach) {
        ASSERT_LT(within, contacts.asked.size());
        EXPECT_EQ(contacts.asked[within].row, found);
        EXPECT_EQ(contacts.asked[within++].pair, i);
      }
      ASSERT_LT(found, feet.asked.size());
      EXPECT_EQ(feet.asked[found].row, found);
      EXPECT_EQ(feet.asked[found].pair, i);
      const ContactNumbers& row = feet.rows[found++];
      const Vector3 foot_F = vertices == Side::FIXED ? Vector3(in.X_FM * foot) : foot,
                    from_fixed = (vertices == Side::FIXED ? -1 : 1) * (placed - foot_F);
      EXPECT_NEAR((Vector3(row.point) - foot_F).norm(), 0, 1e-13);
      EXPECT_NEAR((Vector3(row.normal) - from_fixed.normalized()).norm(), 0, 1e-13);
      EXPECT_NEAR(row.depth, gap, 1e-13);
    }
    EXPECT_EQ(found, feet.count);
    EXPECT_EQ(within, contacts.asked.size());
    EXPECT_GT(found, 15u);
    EXPECT_LT(found, COUNT);
    EXPECT_GT(ends, 2u);
    EXPECT_LT(ends, found);
    EXPECT_GT(within, 3u);
    EXPECT_LT(within, found);
  }
}

TEST(SideFeet, ContactsAreThoseMadeOneByOne) {
  for (const Side vertices : SIDES) {
    const SidesAndVertices in(vertices);
    const Feet feet(*availableKernels().front(), in, true), contacts(*availableKernels().front(), in, false);
    ASSERT_EQ(contacts.count, feet.count);
    const geometry::TriangleMesh mesh = geometry::boxMesh(Vector3::Constant(1));
    const CollisionGeometry geometry(std::make_shared<geometry::TriangleMesh>(mesh));
    ContactRoles roles{vertices, {}};
    roles.radius[vertices] = RADIUS_A;
    roles.radius[!vertices] = RADIUS_B;
    const MeshPair pair{MeshSide(geometry), MeshSide(geometry), in.X_FM, RADIUS_A + RADIUS_B, 1, roles, in.X_WF};
    for (std::uint32_t i = 0; i < feet.count; ++i) {
      const std::uint32_t pair_index = feet.asked[i].pair;
      Contact one;
      const Witness at{{FeatureKind::VERTEX, static_cast<int>(pair_index)}, vector3(in.placed[pair_index])},
          on{{FeatureKind::FACE, in.patches[pair_index]}, Vector3(feet.rows[i].point)};
      placeInWorld(pair, contactBetween(vertices, at, on, Vector3(feet.rows[i].normal), feet.rows[i].depth), &one);
      EXPECT_EQ(std::memcmp(&contacts.rows[i], &one, sizeof(double[7])), 0);
      EXPECT_EQ(contacts.rows[i].id, one.id);
      EXPECT_EQ(contacts.rows[i].weight, 1);
      EXPECT_EQ(contacts.rows[i].pierced, 0u);
    }
  }
}

TEST(SideFeet, AllInstructionSetsFindTheSame) {
  for (const Side vertices : SIDES) {
    for (const bool keeps_feet : {false, true}) {
      const SidesAndVertices in(vertices);
      const Feet baseline(*availableKernels().back(), in, keeps_feet);
      for (const Kernels* set : availableKernels()) {
        SCOPED_TRACE(set->name);
        const Feet each(*set, in, keeps_feet);
        ASSERT_EQ(each.count, baseline.count);
        ASSERT_EQ(each.asked.size(), baseline.asked.size());
        EXPECT_EQ(std::memcmp(each.rows.data(), baseline.rows.data(), each.count * sizeof(ContactNumbers)), 0);
        EXPECT_EQ(std::memcmp(each.asked.data(), baseline.asked.data(), each.asked.size() * sizeof(FadingContact)), 0);
      }
    }
  }
}

TEST(LeavingSides, AreAnsweredAsOneByOne) {
  geometry::RandomShapes random(29);
  const SidesAndVertices in(Side::MOVING);
  std::vector<FaceRecord> faces = in.faces;
  for (FaceRecord& face : faces)
    for (Vec4& side : face.sides) side = vec4(random.point(1).normalized(), 0);
  std::vector<EdgeDirections> directions(2 * COUNT);
  for (EdgeDirections& block : directions) {
    for (int i = 0; i < DIRECTION_BLOCK; ++i) {
      const Vector3 direction = random.integer(0, 2) == 0 ? random.point(1).normalized() : Vector3(Vector3::Zero());
      block.x[i] = direction.x(), block.y[i] = direction.y(), block.z[i] = direction.z();
      block.near[i] = random.integer(0, 1) == 0 ? 1 : -1;
    }
  }
  std::vector<LeavingSide> sides;
  for (std::uint32_t i = 0; i < COUNT; ++i)
    sides.push_back({i, static_cast<std::uint16_t>(random.integer(0, 2)), random.integer(0, 1) == 0, 2 * i,
                     static_cast<std::uint32_t>(random.integer(0, 2))});
  const Matrix3 R = in.X_FM.linear();
  int downs = 0, nears = 0;
  for (const Kernels* set : availableKernels()) {
    SCOPED_TRACE(set->name);
    std::vector<LeadingEdges> leading(COUNT);
    set->leadingAtSides(directions.data(), faces.data(), motionOf(Pose(R)), {in.pairs.data(), sides.data(), COUNT}, leading.data());
    for (std::uint32_t i = 0; i < COUNT; ++i) {
      const FaceRecord& face = faces[sides[i].pair];
      const Vector3 down = R * ((sides[i].is_above ? -1 : 1) * vector3(face.plane)), aside = R * vector3(face.sides[sides[i].side]);
      const LeadingEdges one = set->leadingEdges(&directions[sides[i].first], static_cast<int>(sides[i].blocks), down.data(), aside.data());
      EXPECT_EQ(leading[i].down, one.down);
      EXPECT_EQ(leading[i].near, one.near);
      downs += one.down;
      nears += one.near;
    }
  }
  const int asked = static_cast<int>(COUNT * availableKernels().size());
  EXPECT_GT(nears, asked / 10);
  EXPECT_GT(downs, nears);
  EXPECT_LT(downs, asked);
}

}  // namespace
}  // namespace blem_sim::contact
