#include "blem_sim/contact/surface_cover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "blem_sim/contact/narrow_phase.h"
#include "contact/contact_shapes.h"

namespace blem_sim::contact {
namespace {

struct Counts {
  int covered = 0, all = 0;
};

/** Number of contacts of a mesh with the sheet x < 0, and of those that another surface covers. */
Counts countCovered(const geometry::TriangleMesh& mesh, const Pose& X_WM, const Collider& other, const Pose& X_WO) {
  const Collider sheet = makeCollider(geometry::gridMesh(0.4, 0.4, 1, 1)), body = makeCollider(mesh, 0.0025);
  const Pose X_WS = makePose({-0.2, 0, 0});
  ContactManifold manifold;
  narrowPhase({sheet, X_WS}, {body, X_WM}, {0.01}, searchRoom(), &manifold);
  SurfaceCover cover;
  Counts counts;
  for (const Contact& contact : manifold.contacts) {
    cover.begin(contact, true, sheet, X_WS);
    cover.add(other, X_WO, false);
    counts.covered += cover.isCovered();
    ++counts.all;
  }
  return counts;
}

const Pose BESIDE = makePose({0.2, 0, 0});

TEST(SurfaceCover, EdgeThatGoesOnInAnotherSheetHasNoContactBesideIt) {
  const Pose X_WM = makePose({0.003, 0.02, 0.002});
  const Collider sheet = makeCollider(geometry::gridMesh(0.4, 0.4, 3, 2));
  EXPECT_EQ(countCovered(geometry::pointMesh(Vector3::Zero()), X_WM, sheet, BESIDE).all, 1);
  EXPECT_EQ(countCovered(geometry::pointMesh(Vector3::Zero()), X_WM, sheet, BESIDE).covered, 1);
  // A gap, a step, and a slope down leave the edge as it is.
  for (const Pose& X_WO : {makePose({0.2001, 0, 0}), makePose({0.2, 0, -1e-5}), makePose({0.2, 0, -0.2 * std::tan(0.8)}, {0, 0.8, 0})})
    EXPECT_EQ(countCovered(geometry::pointMesh(Vector3::Zero()), X_WM, sheet, X_WO).covered, 0);
  const std::shared_ptr<const CollisionGeometry> plane = CollisionGeometry::halfSpace(Vector3::UnitZ(), 0);
  Collider ground;
  ground.geometry = plane;
  EXPECT_EQ(countCovered(geometry::pointMesh(Vector3::Zero()), X_WM, ground, Pose::Identity()).covered, 1);
}

TEST(SurfaceCover, EdgesInsideAPlaneHaveNoContactsVerticesAboveItHave) {
  // A cube half over the seam: two corners over this sheet, two crossings of edges with the seam.
  const geometry::TriangleMesh cube = geometry::boxMesh(Vector3::Constant(0.1));
  const Pose X_WM = makePose({0.01, 0.02, 0.0525});
  const Counts flush = countCovered(cube, X_WM, makeCollider(geometry::gridMesh(0.4, 0.4, 1, 1)), BESIDE);
  EXPECT_EQ(flush.all - flush.covered, 2);
  EXPECT_GE(flush.covered, 2);
  EXPECT_EQ(countCovered(cube, X_WM, makeCollider(geometry::gridMesh(0.4, 0.4, 1, 1)), makePose({0.2, 0, -1e-5})).covered, 0);
}

TEST(SurfaceCover, OfSheetsThatLieInEachOtherTheFirstHasTheContact) {
  const Collider sheet = makeCollider(geometry::gridMesh(0.4, 0.4, 1, 1)), other = sheet,
                 ball = makeCollider(geometry::pointMesh(Vector3::Zero()), 0.0025);
  const Pose X_WM = makePose({-0.003, 0.02, 0.002});
  ContactManifold manifold;
  narrowPhase({sheet, Pose::Identity()}, {ball, X_WM}, {0.01}, searchRoom(), &manifold);
  ASSERT_EQ(manifold.contacts.size(), 1u);
  SurfaceCover cover;
  for (const bool first : {true, false}) {
    cover.begin(manifold.contacts[0], true, sheet, Pose::Identity());
    cover.add(other, makePose({-0.1, 0, 0}), first);
    EXPECT_EQ(cover.isCovered(), first);
  }
}

}  // namespace
}  // namespace blem_sim::contact
