// Vertices beside faces: the kernels find the closest points of the faces' sides, with every instruction set the same ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "geometry/random_shapes.h"
#include "kernels/kernels.h"
#include "tolerances.h"
#include "vectors.h"
#include "world_contact.h"

namespace blem_sim {
namespace {

using namespace kernels;

constexpr std::uint32_t COUNT = 61;  // no whole number of vectors
constexpr double RADIUS_A = 0.2, RADIUS_B = 0.1;

/** A vertex beside one side of a face each. */
struct SidesAndVertices {
  explicit SidesAndVertices(bool faces_move)
      : faces_move(faces_move), X_FM(makePose({0.1, -0.2, 0.3}, {0.4, 0.5, -0.6})), X_WF(makePose({-3, 2, 1}, {0.7, -0.2, 0.1})) {
    RandomShapes random(23);
    for (std::uint32_t i = 0; i < COUNT; ++i) {
      const Triangle t = random.triangle(1);
      const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized(), p = random.point(1);
      placed.push_back(vec4(faces_move ? Vector3(X_FM * p) : p, nameBits(i)));
      faces.push_back({vec4(normal, normal.dot(t[0])), {}});
      sides.push_back({vec4(t[0], 0), vec4(t[1] - t[0], 0)});
      pairs.push_back({i, i});
    }
  }

  std::vector<SideFoot> feet(const Kernels& set, bool keeps_feet) const {
    // The vertices are A's: the moving mesh is A unless its faces are asked.
    const ContactPlace place{nullptr, true,      motionOf(X_FM), motionOf(X_WF), RADIUS_A + RADIUS_B, 0.5 * (RADIUS_B - RADIUS_A),
                             0,       keeps_feet};
    std::vector<SideFoot> out(COUNT);
    set.sideFeet(place, {placed.data(), faces_move, motionOf(X_FM.inverse())}, faces.data(), sides.data(), pairs.data(), COUNT, out.data());
    return out;
  }

  bool faces_move;
  Pose X_FM, X_WF;
  std::vector<Vec4> placed;  // vertices in frame F
  std::vector<FaceRecord> faces;
  std::vector<BesideSide> sides;
  std::vector<Candidate> pairs;
};

TEST(SideFeet, AreTheClosestPointsOfTheSides) {
  for (const bool faces_move : {false, true}) {
    const SidesAndVertices in(faces_move);
    const std::vector<SideFoot> feet = in.feet(*availableKernels().front(), true);
    int ends = 0;
    for (std::uint32_t i = 0; i < COUNT; ++i) {
      const Vector3 placed = vector3(in.placed[i]), p = faces_move ? Vector3(in.X_FM.inverse() * placed) : placed,
                    normal = vector3(in.faces[i].plane), start = vector3(in.sides[i].start), along = vector3(in.sides[i].along),
                    projection = p - (normal.dot(p) - in.faces[i].plane.w) * normal;
      const double part = std::clamp((projection - start).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const Vector3 foot = start + part * along, foot_F = faces_move ? Vector3(in.X_FM * foot) : foot;
      ends += part == 0 || part == 1;
      const Vector3 from_fixed = (faces_move ? -1 : 1) * (vector3(in.placed[i]) - foot_F);
      EXPECT_NEAR((Vector3(feet[i].point) - foot_F).norm(), 0, 1e-13);
      EXPECT_NEAR(feet[i].distance, (p - foot).norm(), 1e-13);
      EXPECT_NEAR((feet[i].distance * Vector3(feet[i].normal) - from_fixed).norm(), 0, 1e-13);
      EXPECT_NEAR(feet[i].lost, FADE_SLOPE * (projection - foot).norm(), 1e-13);
    }
    EXPECT_GT(ends, 5);
    EXPECT_LT(ends, 55);
  }
}

TEST(SideFeet, ContactsAreThoseMadeOneByOne) {
  for (const bool faces_move : {false, true}) {
    const SidesAndVertices in(faces_move);
    const std::vector<SideFoot> feet = in.feet(*availableKernels().front(), true), contacts = in.feet(*availableKernels().front(), false);
    const TriangleMesh mesh = boxMesh(Vector3::Constant(1));
    const CollisionGeometry geometry(std::make_shared<TriangleMesh>(mesh));
    const MeshPair pair{
        MeshSide(geometry), MeshSide(geometry), in.X_FM, RADIUS_A + RADIUS_B, 1, {!faces_move, RADIUS_A, RADIUS_B}, in.X_WF};
    for (std::uint32_t i = 0; i < COUNT; ++i) {
      Contact one;
      placeInWorld(pair, !faces_move, {FeatureKind::VERTEX, 0}, {FeatureKind::FACE, 0}, vector3(in.placed[i]), Vector3(feet[i].point),
                   Vector3(feet[i].normal), feet[i].distance, &one);
      EXPECT_EQ(Vector3(contacts[i].point), one.point);
      EXPECT_EQ(Vector3(contacts[i].normal), one.normal_BA);
      EXPECT_EQ(contacts[i].distance, feet[i].distance);
      EXPECT_EQ(contacts[i].lost, feet[i].lost);
    }
  }
}

TEST(SideFeet, AllInstructionSetsFindTheSame) {
  for (const bool faces_move : {false, true}) {
    for (const bool keeps_feet : {false, true}) {
      const SidesAndVertices in(faces_move);
      const std::vector<SideFoot> baseline = in.feet(*availableKernels().back(), keeps_feet);
      for (const Kernels* set : availableKernels())
        EXPECT_EQ(std::memcmp(in.feet(*set, keeps_feet).data(), baseline.data(), COUNT * sizeof(SideFoot)), 0) << set->name;
    }
  }
}

}  // namespace
}  // namespace blem_sim
