// Sides of faces over which contacts fade.
#include "neighbourhood/border_kind.h"

#include <gtest/gtest.h>

#include "contact/contact_shapes.h"

namespace blem_sim::contact {
namespace {

// Each face of a box goes on over one side; over the others the surface falls as seen from outside, and rises as seen from inside.
TEST(OpenSides, FallAwayFromSurfacesOnly) {
  constexpr kernels::OpenSides ABOVE = 7, BELOW = 7 << 3;
  const Collider box = makeCollider(geometry::boxMesh(Vector3::Constant(0.1)), 0);
  const MeshSide side(*box.geometry);
  SurroundingsMemory surroundings;
  for (int face = 0; face < 12; ++face) {
    const kernels::OpenSides open = openSides(borderKinds(side, face, &surroundings)), to_points = open >> kernels::OPEN_TO_POINTS;
    EXPECT_EQ(__builtin_popcount(open & ABOVE), 2) << face;
    EXPECT_EQ(__builtin_popcount(open & BELOW), 2) << face;
    EXPECT_EQ(to_points & ABOVE, 0) << face;
    EXPECT_EQ(to_points & BELOW, open & BELOW) << face;
  }
}

}  // namespace
}  // namespace blem_sim::contact
