#include "clouds/leaving_triangles.h"

#include <gtest/gtest.h>

#include <memory>

namespace blem_sim::sim {
namespace {

/** A level grid of 4 x 4 squares of 1 m, the second one beside it. */
std::vector<contact::Collider> twoGrids() {
  std::vector<contact::Collider> colliders(2);
  for (contact::Collider& collider : colliders)
    collider.geometry =
        std::make_shared<const contact::CollisionGeometry>(std::make_shared<const geometry::TriangleMesh>(geometry::gridMesh(4, 4, 4, 4)));
  colliders[1].X_BC = makePose({10, 0, 0});
  return colliders;
}

/** The corner of the grid's squares in the middle, and its number there. */
int middleOf(const geometry::TriangleMesh& mesh) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.vertices[v].norm() < 1e-9) return static_cast<int>(v);
  return -1;
}

TEST(LeavingTriangles, AreThoseAroundATouchedVertex) {
  const std::vector<contact::Collider> colliders = twoGrids();
  const int middle = middleOf(colliders[0].geometry->mesh());
  LeavingTriangles triangles(colliders);
  for (int i = 0; i < 2; ++i) triangles.addTouched(0, {Vector3i::Constant(middle), Vector3::UnitX()}, Vector3::Zero(), 0.001);
  FadingPoints fading;
  fading.add(0, -1, {{middle, 0.0005}});
  const SunkSurface surface = triangles.surface(makePose({0, 0, 1}), fading, 1e-6);
  EXPECT_GE(surface.mesh.elements.size(), 6u);
  EXPECT_LE(surface.mesh.elements.size(), 8u);
  ASSERT_EQ(surface.sunk.size(), surface.mesh.vertices.size());
  for (const SunkPoint& point : surface.sunk) {
    const bool held = (surface.mesh.vertices[point.vertex] - Vector3(0, 0, 1)).norm() < 1e-9;
    EXPECT_EQ(point.sink, held ? 0.0005 : 0.001) << point.vertex;  // what is touched keeps its sink
  }
}

TEST(LeavingTriangles, LieAheadOfWhatMovesAndStayApart) {
  const std::vector<contact::Collider> colliders = twoGrids();
  const int middle = middleOf(colliders[0].geometry->mesh());
  LeavingTriangles still(colliders), moving(colliders), both(colliders);
  const contact::MeshPlace place{Vector3i::Constant(middle), Vector3::UnitX()};
  still.addTouched(0, place, Vector3::Zero(), 0);
  moving.addTouched(0, place, Vector3(1.5, 0, 0), 0);
  for (const int mesh : {0, 1}) both.addTouched(mesh, place, Vector3::Zero(), 0);
  const auto surfaceOf = [](const LeavingTriangles& triangles) { return triangles.surface(Pose::Identity(), FadingPoints(), 1e-6); };
  EXPECT_EQ(surfaceOf(still).mesh.bounds().max().x(), 1);
  EXPECT_EQ(surfaceOf(moving).mesh.bounds().max().x(), 2);
  EXPECT_EQ(surfaceOf(moving).mesh.bounds().min().x(), -1);
  EXPECT_EQ(surfaceOf(both).mesh.elements.size(), 2 * surfaceOf(still).mesh.elements.size());
  EXPECT_EQ(surfaceOf(both).mesh.bounds().max().x(), 11);
}

}  // namespace
}  // namespace blem_sim::sim
