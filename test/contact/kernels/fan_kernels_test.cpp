// Fans of rays: the kernels find what castRay finds for each ray alone, with every instruction set the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "blem_sim/geometry/ray_cast.h"
#include "geometry/random_shapes.h"
#include "kernels/kernels.h"

namespace blem_sim::contact {
namespace {

using namespace kernels;

constexpr double ENDLESS = std::numeric_limits<double>::infinity();

/** Triangles with a tree; every third one is there twice, so that hits tie. */
struct Soup {
  explicit Soup(int count, double size) {
    geometry::RandomShapes random(7);
    for (int i = 0; i < count; ++i) {
      const Vector3 middle = random.point(1);
      const int first = static_cast<int>(mesh.vertices.size());
      for (int k = 0; k < 3; ++k) mesh.vertices.push_back(middle + random.point(size));
      for (int copy = 0; copy < (i % 3 ? 1 : 2); ++copy) mesh.elements.emplace_back(first, first + 1, first + 2);
    }
    tree = geometry::Bvh(mesh, MAX_LEAF_ELEMENTS);
  }
  FanTree numbers() const { return {reinterpret_cast<const unsigned char*>(tree.nodes().data()), 0}; }
  FanMesh numbers(int axis) const {
    return {numbers(), tree.order().data(), mesh.elements.data()->data(), mesh.vertices.data()->data(), axis};
  }

  geometry::TriangleMesh mesh;
  geometry::Bvh tree;
};

/** Rays from a point, longest along one axis; some run along the others exactly. */
struct Rays {
  Rays(geometry::RandomShapes* random, int axis, double spread) : origin(random->point(0.5)) {
    origin[axis] = random->uniform(-1, 1) > 0 ? 2 : -2;
    const Vector3 ahead = random->point(spread);
    for (int ray = 0; ray < FAN; ++ray) {
      Vector3 direction = ahead + random->point(0.1 * spread);
      if (ray == 3) direction[(axis + 1) % 3] = random->uniform(-1, 1) > 0 ? 0.0 : -0.0;
      direction[axis] = origin[axis] > 0 ? -1 : 1;
      directions.push_back(direction);
    }
  }
  FanRays numbers(double nearest) const {
    FanRays fan;
    fan.nearest = nearest;
    for (int k = 0; k < 3; ++k) {
      fan.origin[k] = origin[k];
      for (int ray = 0; ray < FAN; ++ray) fan.directions[k][ray] = directions[ray][k];
    }
    return fan;
  }

  Vector3 origin;
  std::vector<Vector3> directions;
};

FanHits noneBefore(const std::vector<double>& farthest) {
  FanHits hits;
  std::copy(farthest.begin(), farthest.end(), hits.t);
  std::fill(hits.element, hits.element + FAN, -1);
  return hits;
}

TEST(FanKernels, FindWhatEachRayFindsAlone) {
  const Soup soup(3000, 0.2);
  for (const Kernels* kernels : availableKernels()) {
    geometry::RandomShapes random(3);
    int hits = 0, left_out = 0;
    for (int trial = 0; trial < 600; ++trial) {
      const int axis = trial % 3;
      const Rays rays(&random, axis, trial % 2 ? 0.1 : 0.9);
      const double nearest = random.uniform(-0.5, 1.5);
      std::vector<double> farthest(FAN);
      for (double& end : farthest) end = random.uniform(-1, 4);
      if (trial % 5 == 0) farthest.assign(FAN, ENDLESS);
      FanHits found = noneBefore(farthest);
      EXPECT_FALSE(kernels->fanTriangles(soup.numbers(axis), rays.numbers(nearest), &found));
      for (int ray = 0; ray < FAN; ++ray) {
        const geometry::RayHit alone =
            geometry::castRay({soup.tree, soup.mesh}, {rays.origin, rays.directions[ray]}, {nearest, farthest[ray]});
        ASSERT_EQ(found.element[ray], alone.element) << kernels->name << ", trial " << trial << ", ray " << ray;
        ASSERT_EQ(found.t[ray], alone.element < 0 ? farthest[ray] : alone.t) << kernels->name << ", trial " << trial << ", ray " << ray;
        hits += alone.element >= 0;
        left_out += alone.element < 0;
      }
    }
    EXPECT_GT(hits, 1000);
    EXPECT_GT(left_out, 500);
  }
}

TEST(FanKernels, TellOfWhatIsNoTriangle) {
  geometry::TriangleMesh mesh = geometry::boxMesh({1, 1, 1});
  mesh.elements.emplace_back(0, 1, 1);
  const geometry::Bvh tree(mesh, MAX_LEAF_ELEMENTS);
  geometry::RandomShapes random(5);
  Rays rays(&random, 0, 0.1);
  rays.origin = {-2, 0, 0};
  rays.directions.assign(FAN, {1, 0.01, 0.02});
  for (const Kernels* kernels : availableKernels()) {
    FanHits found = noneBefore(std::vector<double>(FAN, ENDLESS));
    const FanMesh target{{reinterpret_cast<const unsigned char*>(tree.nodes().data()), 2},
                         tree.order().data(),
                         mesh.elements.data()->data(),
                         mesh.vertices.data()->data(),
                         0};
    EXPECT_TRUE(kernels->fanTriangles(target, rays.numbers(0), &found)) << kernels->name;
    EXPECT_DOUBLE_EQ(found.t[7], 1.5) << kernels->name;
  }
}

/** Leaves, and for each ray whether it was among the lanes. */
struct Visited {
  static void visit(void* self, std::uint32_t leaf, unsigned lanes) { static_cast<Visited*>(self)->lanes[leaf] |= lanes; }
  std::vector<unsigned> lanes;
};

TEST(FanKernels, VisitTheLeavesThatEachRayMeets) {
  const Soup soup(500, 0.1);
  for (const Kernels* kernels : availableKernels()) {
    geometry::RandomShapes random(11);
    int met = 0;
    for (int trial = 0; trial < 100; ++trial) {
      const Rays rays(&random, trial % 3, 0.5);
      Visited visited{std::vector<unsigned>(soup.tree.nodes().size(), 0)};
      std::vector<double> farthest(FAN, random.uniform(0, 4));
      kernels->fanLeaves(soup.numbers(), rays.numbers(0.5), farthest.data(), {Visited::visit, &visited});
      for (int ray = 0; ray < FAN; ++ray) {
        std::vector<unsigned> alone(soup.tree.nodes().size(), 0);
        geometry::visitLeavesAlong(geometry::RaySlabs({rays.origin, rays.directions[ray]}, 0.5, 0), soup.tree, &farthest[ray],
                                   [&](std::uint32_t leaf) { alone[leaf] = 1; });
        for (std::size_t leaf = 0; leaf < alone.size(); ++leaf) {
          ASSERT_EQ(visited.lanes[leaf] >> ray & 1, alone[leaf]) << kernels->name << ", trial " << trial << ", ray " << ray;
          met += static_cast<int>(alone[leaf]);
        }
      }
    }
    EXPECT_GT(met, 1000);
  }
}

}  // namespace
}  // namespace blem_sim::contact
