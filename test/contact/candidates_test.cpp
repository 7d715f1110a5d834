// What is ruled out before the exact work can have no contact.
#include "candidates.h"

#include <gtest/gtest.h>

#include "geometry/random_shapes.h"

namespace blem_sim {
namespace {

constexpr double RANGE = 0.02;  // [m]

struct Shape {
  TriangleMesh mesh;
  MeshTopology topology;
  ElementShape element;

  explicit Shape(const Triangle& corners) {
    mesh.vertices = {corners[0], corners[1], corners[2]};
    mesh.elements = {{0, 1, 2}};
    topology = MeshTopology(mesh);
    element.element = 0;
    for (int k = 0; k < 3; ++k) element.corners[k] = corners[k];
    describe(topology, nullptr, &element);
  }
};

TEST(Candidates, CornersRuledOutLieWithinNoConeOfTheSide) {
  RandomShapes random(3);
  int ruled_out = 0;
  for (int i = 0; i < 20000; ++i) {
    const Shape a(random.triangle(0.02)), b(random.triangle(0.02));
    const Candidates of_a = candidatesOf(a.element, nullptr, b.element, RANGE);
    for (int k = 0; k < 3; ++k) {
      const Vector3 inward = a.topology.inward(a.mesh, a.topology.element_edges[0][k], 0);
      for (int j = 0; j < 3; ++j) {
        if (mayMeetCorner(of_a, k, j)) continue;
        ++ruled_out;
        const Vector3 x = random.uniform(0, 1) * (a.element.corners[NEXT[k]] - a.element.corners[k]) + a.element.corners[k];
        const Vector3 d = b.element.corners[j] - x;
        EXPECT_TRUE(d.norm() > RANGE || d.dot(inward) > EDGE_CONE_SLACK * d.norm());
      }
    }
  }
  EXPECT_GT(ruled_out, 10000);
}

TEST(Candidates, ProjectionsRuledOutAreFartherOut) {
  RandomShapes random(4);
  int ruled_out = 0;
  for (int i = 0; i < 20000; ++i) {
    const Shape face(random.triangle(0.02));
    const double height = random.uniform(-0.01, 0.01), most = random.uniform(0, 0.002);
    const Vector3 p = random.point(0.02), on_plane = p - face.element.normal.dot(p - face.element.corners[0]) * face.element.normal;
    if (mayHoldProjection(face.element, on_plane + height * face.element.normal, most)) continue;
    ++ruled_out;
    const Triangle corners = {face.element.corners[0], face.element.corners[1], face.element.corners[2]};
    EXPECT_FALSE(holdsProjection(face.element, p));
    EXPECT_GT(closestPointTriangle(on_plane, corners).distance, most);
  }
  EXPECT_GT(ruled_out, 5000);
}

}  // namespace
}  // namespace blem_sim
