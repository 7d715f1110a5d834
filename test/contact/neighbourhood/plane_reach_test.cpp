// Beyond a face's plane reach nothing beside the face lies over another face of the plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "blem_sim/geometry/closest_points.h"
#include "contact/contact_shapes.h"
#include "features/tolerances.h"
#include "kernels/vectors.h"
#include "neighbourhood/leaf_features.h"
#include "neighbourhood/plane_reach.h"

namespace blem_sim::contact {
namespace {

/** Distance [m] of a point's projection from a face; 0 over it. */
double besideFace(const geometry::TriangleMesh& mesh, int face, const Vector3& p) {
  const Vector3i& e = mesh.elements[face];
  const Vector3 normal = geometry::MeshTopology::normal(mesh, face), projection = p - normal.dot(p - mesh.vertices[e[0]]) * normal;
  return geometry::closestPointTriangle(projection, geometry::triangleOf(mesh, face)).distance;
}

/** Whether p is inside all sides of the face, but for so little as counts as over it. */
bool isOver(const kernels::FaceRecord& face, const Vector3& p) {
  return std::all_of(std::begin(face.sides), std::end(face.sides),
                     [&](const kernels::Vec4& side) { return vector3(side).dot(p) - side.w >= -2 * CLOSED; });
}

/** Whether p is outside of some sides, behind none of which the plane goes on. */
bool mayFade(const MeshSide& side, int face, const kernels::FaceRecord& record, const Vector3& p) {
  bool is_outside = false;
  for (int k = 0; k < 3; ++k) {
    if (vector3(record.sides[k]).dot(p) >= record.sides[k].w) continue;
    if (side.topology.isFlatEdge(side.topology.edgeOf(face, k))) return false;
    is_outside = true;
  }
  return is_outside;
}

/** A plate without one of its corners, or with all, its vertices off the plane and its grid's lines by that much [m]. */
geometry::TriangleMesh plateMesh(geometry::RandomShapes& random, bool is_whole, double off, double noise) {
  geometry::TriangleMesh plate;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      const bool inner = x > 0 && x < 3 && y > 0 && y < 3;
      const double shift = inner ? noise : 0;
      plate.vertices.emplace_back(0.1 * x + random.uniform(-shift, shift), 0.1 * y + random.uniform(-shift, shift),
                                  random.uniform(-off, off));
    }
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      const int v = 4 * y + x;
      if (!is_whole && x == 2 && y == 2) continue;
      plate.elements.emplace_back(v, v + 1, v + 5);
      plate.elements.emplace_back(v, v + 5, v + 4);
    }
  const Pose X = random.pose(1);
  for (Vector3& v : plate.vertices) v = X * v;
  return plate;
}

TEST(PlaneReach, NothingFartherBesideIsOverAnotherFace) {
  geometry::RandomShapes random(41);
  int over = 0;
  for (int round = 0; round < 24; ++round) {
    const auto mesh =
        std::make_shared<geometry::TriangleMesh>(plateMesh(random, round % 3 == 0, round % 2 ? 2e-8 : 0, round % 4 ? 0.04 : 0));
    const CollisionGeometry geometry(mesh);
    const MeshSide side(geometry);
    for (int face = 0; face < static_cast<int>(mesh->elements.size()); ++face) {
      const PlaneReach reach = planeReach(side, face);
      const kernels::FaceRecord record = faceRecord(side, face);
      const Vector3 normal = vector3(record.plane);
      for (int i = 0; i < 400; ++i) {
        // Points around the corners of all faces, where those of a plane meet, and anywhere.
        const Vector3& corner = mesh->vertices[static_cast<std::size_t>(random.integer(0, 15))];
        const double height = random.uniform(-1, 1);
        const Vector3 p = corner + random.point(std::pow(10, random.uniform(-9, -1))),
                      lifted = p + (height - normal.dot(p) + record.plane.w) * normal;
        if (!mayFade(side, face, record, lifted)) continue;
        const double beside = besideFace(*mesh, face, lifted);
        for (int other = 0; other < static_cast<int>(mesh->elements.size()); ++other) {
          if (other == face || side.topology.patchOf(other) != side.topology.patchOf(face)) continue;
          if (!isOver(faceRecord(side, other), lifted)) continue;
          ++over;
          EXPECT_LE(beside, reach.at(std::abs(height)));
        }
      }
    }
  }
  EXPECT_GT(over, 100);
}

TEST(PlaneReach, IsShortWhereThePlaneIsConvex) {
  geometry::RandomShapes random(43);
  const auto box = std::make_shared<geometry::TriangleMesh>(geometry::boxMesh(Vector3(0.1, 0.2, 0.3)));
  const auto plate = std::make_shared<geometry::TriangleMesh>(plateMesh(random, true, 0, 0.02));
  const auto notched = std::make_shared<geometry::TriangleMesh>(plateMesh(random, false, 0, 0));
  for (const auto& mesh : {box, plate, notched}) {
    const CollisionGeometry geometry(mesh);
    double longest = 0;
    for (int face = 0; face < static_cast<int>(mesh->elements.size()); ++face)
      longest = std::max(longest, planeReach(MeshSide(geometry), face).at(0.05));
    if (mesh == notched) {
      EXPECT_GT(longest, 0.1);
    } else {
      EXPECT_LT(longest, 1e-6);
    }
  }
}

TEST(PlaneReach, OfManyFacesIsInfinite) {
  const CollisionGeometry geometry(std::make_shared<geometry::TriangleMesh>(geometry::gridMesh(1, 1, 10, 10)));
  EXPECT_EQ(planeReach(MeshSide(geometry), 0).at(0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace blem_sim::contact
