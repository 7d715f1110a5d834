// Memory of a collision geometry: bytes() are those that malloc gave, and at most 90 per triangle (150 where four faces share edges).
#include <gtest/gtest.h>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)

#include "contact/contact_shapes.h"
#include "support/counted_allocations.h"

namespace blem_sim::contact {
namespace {

geometry::TriangleMesh roughBall() {
  geometry::RandomShapes random(23);
  geometry::TriangleMesh ball = geometry::icosphereMesh(1, 6);
  for (Vector3& v : ball.vertices) v *= random.uniform(0.999, 1.001);
  return ball;
}

geometry::TriangleMesh roughGrid() {
  geometry::RandomShapes random(24);
  geometry::TriangleMesh grid = geometry::gridMesh(1, 1, 200, 200);
  for (Vector3& v : grid.vertices) v.z() = random.uniform(-1e-3, 1e-3);
  return grid;
}

/** A leaf on every edge of a row: edges of four faces. */
geometry::TriangleMesh book() {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < 10000; ++i) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{0.1 * i, 0, 0}, {0.1 * i, 1, 0}});
    for (int page = 0; page < 4; ++page) {
      mesh.vertices.emplace_back(0.1 * i + 0.02 * (page - 1.5), 0.5, 1);
      mesh.elements.emplace_back(first, first + 1, first + 2 + page);
    }
  }
  return mesh;
}

struct SurfaceRow {
  const char* name;
  geometry::TriangleMesh (*make)();
  double bytes_per_triangle;  // at most
};

class GeometryMemory : public testing::TestWithParam<SurfaceRow> {};

TEST_P(GeometryMemory, IsWhatMallocGaveAndLittle) {
  const geometry::TriangleMesh soup = GetParam().make();
  { CollisionGeometry warm_up(std::make_shared<const geometry::TriangleMesh>(geometry::cleanMesh(soup, nullptr))); }
  const long before = held_bytes;
  const CollisionGeometry geometry(std::make_shared<const geometry::TriangleMesh>(geometry::cleanMesh(soup, nullptr)));
  const double held = static_cast<double>(held_bytes - before), told = static_cast<double>(geometry.bytes());
  // Beside the arrays there are a few shared objects, and malloc rounds large arrays up to pages.
  EXPECT_GE(held, told);
  EXPECT_LE(held, 1.01 * told + 20 * 4096);
  EXPECT_LE(told / static_cast<double>(geometry.mesh().elements.size()), GetParam().bytes_per_triangle);
}

// The row of four faces on an edge has 1.5 vertices and 2.25 edges per triangle, a closed surface 0.5 and 1.5.
INSTANTIATE_TEST_SUITE_P(Surfaces, GeometryMemory,
                         testing::Values(SurfaceRow{"rough_ball", roughBall, 90}, SurfaceRow{"rough_grid", roughGrid, 90},
                                         SurfaceRow{"gridded_box",
                                                    [] {
                                                      return geometry::subdivided(geometry::boxMesh({1, 2, 3}), 6);
                                                    },
                                                    90},
                                         SurfaceRow{"edges_of_four_faces", book, 150}),
                         [](const auto& info) { return info.param.name; });

TEST(GeometryMemory, OfAHalfSpaceIsNone) { EXPECT_EQ(CollisionGeometry::halfSpace(Vector3::UnitZ(), 0)->bytes(), 0u); }

}  // namespace
}  // namespace blem_sim::contact

#endif
