#include "blem_sim/geometry/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "blem_sim/geometry/bvh_traversal.h"
#include "blem_sim/geometry/closest_points.h"
#include "geometry/random_shapes.h"

namespace blem_sim::geometry {
namespace {

TriangleMesh bumpySphere(RandomShapes& random, int level) {
  TriangleMesh mesh = icosphereMesh(0.1, level);
  for (Vector3& v : mesh.vertices) v *= random.uniform(0.8, 1.2);
  return mesh;
}

TriangleMesh triangleSoup(RandomShapes& random, int count) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vector3 centre = random.point(1);
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(centre + random.point(0.1));
    mesh.elements.push_back(i % 7 == 0 ? Vector3i(3 * i, 3 * i, 3 * i) : Vector3i(3 * i, 3 * i + 1, 3 * i + 2));
  }
  return mesh;
}

/** Each element in exactly one leaf, each box holds its children or elements, no leaf too large, no branch too deep. */
void expectSound(const Bvh& tree, const TriangleMesh& mesh, std::uint32_t leaf_size) {
  std::vector<int> seen(mesh.elements.size(), 0);
  std::vector<std::pair<std::uint32_t, int>> open = {{0, 0}};
  std::size_t visited = 0;
  while (!open.empty()) {
    const auto [index, depth] = open.back();
    open.pop_back();
    ++visited;
    ASSERT_LE(depth, Bvh::MAX_DEPTH);
    const Bvh::Node& node = tree.nodes()[index];
    const Box box(node.lower.cast<double>(), node.upper.cast<double>());
    if (node.isLeaf()) {
      ASSERT_LE(node.count, leaf_size);
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        ++seen[tree.order()[i]];
        for (const Vector3& corner : triangleOf(mesh, static_cast<int>(tree.order()[i]))) ASSERT_TRUE(box.contains(corner));
      }
      continue;
    }
    for (std::uint32_t child = node.first; child < node.first + 2; ++child) {
      const Bvh::Node& below = tree.nodes()[child];
      ASSERT_TRUE(box.contains(Box(below.lower.cast<double>(), below.upper.cast<double>())));
      open.emplace_back(child, depth + 1);
    }
  }
  EXPECT_EQ(visited, tree.nodes().size());
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int count) { return count == 1; }));
}

TEST(Bvh, IsSoundForMeshesCloudsAndOneElement) {
  RandomShapes random(1);
  std::vector<TriangleMesh> meshes = {bumpySphere(random, 3), triangleSoup(random, 1000), gridMesh(2, 1, 40, 20),
                                      boxMesh({1, 2, 3}),     pointMesh({1, 2, 3}),       segmentMesh({0, 0, 0}, {1, 1, 1})};
  std::vector<Vector3> cloud;
  for (int i = 0; i < 500; ++i) cloud.push_back(random.point(1));
  meshes.push_back(pointCloudMesh(cloud, nullptr));
  for (const TriangleMesh& mesh : meshes) {
    for (const int leaf_size : {1, 4, 8}) expectSound(Bvh(mesh, leaf_size), mesh, leaf_size);
  }
}

TEST(Bvh, IsEmptyForAnEmptyMesh) {
  const Bvh tree{TriangleMesh()};
  EXPECT_TRUE(tree.empty());
  visitLeaves(tree, Box(Vector3(-1, -1, -1), Vector3(1, 1, 1)), [](std::uint32_t) { ADD_FAILURE(); });
  visitLeavesBelowPlane(tree, Vector3(0, 0, 1), 0, 1, [](std::uint32_t) { ADD_FAILURE(); });
  visitLeafPairs(tree, Bvh(boxMesh({1, 1, 1})), Pose::Identity(), 1, [](std::uint32_t, std::uint32_t) { ADD_FAILURE(); });
  EXPECT_EQ(distanceToMesh(tree, TriangleMesh(), {0, 0, 0}), std::numeric_limits<double>::infinity());
}

TEST(Bvh, IsSoundWhereSplitsFail) {
  // A thousand times the same triangle; points on a line; sizes over sixty decades; nothing but one place.
  TriangleMesh same;
  same.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  same.elements.assign(1000, {0, 1, 2});
  expectSound(Bvh(same), same, 4);

  TriangleMesh line, decades, one_place;
  for (int i = 0; i < 1000; ++i) {
    line.vertices.emplace_back(0.1 * i, 0, 0);
    decades.vertices.emplace_back(std::pow(10, -30 + 0.06 * i), 0, std::pow(10, -0.06 * i));
    one_place.vertices.emplace_back(0.1, 0.2, 0.3);
    for (TriangleMesh* mesh : {&line, &decades, &one_place}) mesh->elements.emplace_back(i, i, i);
  }
  for (const TriangleMesh& mesh : {line, decades, one_place}) expectSound(Bvh(mesh, 1), mesh, 1);
}

TEST(Bvh, IsTheSameTwice) {
  RandomShapes random(2);
  const TriangleMesh mesh = triangleSoup(random, 3000);
  const Bvh one(mesh), two(mesh);
  EXPECT_EQ(one.order(), two.order());
  ASSERT_EQ(one.nodes().size(), two.nodes().size());
  for (std::size_t i = 0; i < one.nodes().size(); ++i) {
    ASSERT_EQ(one.nodes()[i].lower, two.nodes()[i].lower);
    ASSERT_EQ(one.nodes()[i].upper, two.nodes()[i].upper);
    ASSERT_EQ(one.nodes()[i].first, two.nodes()[i].first);
  }
}

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/** Pairs of elements in the leaf pairs visited; fails when a leaf pair comes twice. */
Pairs candidatePairs(const Bvh& a, const Bvh& b, const Pose& X_BA, double margin) {
  Pairs leaves, elements;
  visitLeafPairs(a, b, X_BA, margin, [&](std::uint32_t leaf_a, std::uint32_t leaf_b) {
    EXPECT_TRUE(leaves.emplace(leaf_a, leaf_b).second) << "a pair of leaves visited twice";
    const Bvh::Node &node_a = a.nodes()[leaf_a], &node_b = b.nodes()[leaf_b];
    for (std::uint32_t i = node_a.first; i < node_a.first + node_a.count; ++i) {
      for (std::uint32_t j = node_b.first; j < node_b.first + node_b.count; ++j) elements.emplace(a.order()[i], b.order()[j]);
    }
  });
  return elements;
}

TEST(VisitLeafPairs, MissesNoPairWithinTheMarginAndSkipsMostOthers) {
  RandomShapes random(3);
  const TriangleMesh a = bumpySphere(random, 2), b = bumpySphere(random, 2);
  const Bvh tree_a(a), tree_b(b);
  std::size_t found = 0, true_pairs = 0;
  const int poses = 12;
  for (int trial = 0; trial < poses; ++trial) {
    Pose X_BA = random.pose(1);
    X_BA.translation() *= 0.2 / X_BA.translation().norm();
    const double margin = trial % 2 == 0 ? 0.002 : 0.02;
    const Pairs candidates = candidatePairs(tree_a, tree_b, X_BA, margin);
    found += candidates.size();
    for (std::uint32_t i = 0; i < a.elements.size(); ++i) {
      const Triangle triangle_a = X_BA * triangleOf(a, static_cast<int>(i));
      for (std::uint32_t j = 0; j < b.elements.size(); ++j) {
        if (closestTriangleTriangle(triangle_a, triangleOf(b, static_cast<int>(j))).distance > margin) continue;
        ++true_pairs;
        ASSERT_TRUE(candidates.count({i, j})) << "pair " << i << ", " << j << " of pose " << trial;
      }
    }
  }
  EXPECT_GT(true_pairs, 100u);
  EXPECT_LT(found, poses * a.elements.size() * b.elements.size() / 10);
}

TEST(VisitLeafPairs, KeepsPairsExactlyAtTheMargin) {
  // Two boxes a margin apart, in frames far from the origin: rounding must not lose the pair.
  RandomShapes random(4);
  const TriangleMesh box = boxMesh({1, 1, 1});
  for (int trial = 0; trial < 1000; ++trial) {
    const double margin = trial % 2 == 0 ? 0.0 : random.uniform(0, 1);
    const Pose X_WC = random.pose(1000), X_WD = random.pose(1000);
    const TriangleMesh a = transformed(box, X_WC.inverse()),
                       b = transformed(transformed(box, makePose({1 + margin, 0, 0})), X_WD.inverse());
    const Pairs candidates = candidatePairs(Bvh(a), Bvh(b), X_WD.inverse() * X_WC, margin + 1e-11);
    // Faces 10, 11 of a look at faces 8, 9 of b.
    for (const std::uint32_t i : {10u, 11u}) {
      for (const std::uint32_t j : {8u, 9u}) ASSERT_TRUE(candidates.count({i, j})) << "trial " << trial;
    }
  }
}

TEST(VisitLeafPairs, OrderComesFromTheTreesAlone) {
  RandomShapes random(5);
  const TriangleMesh a = bumpySphere(random, 2), b = bumpySphere(random, 3);
  const Bvh tree_a(a), tree_b(b);
  const auto sequence = [&](const Pose& X_BA, double margin) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
    visitLeafPairs(tree_a, tree_b, X_BA, margin, [&](std::uint32_t i, std::uint32_t j) { order.emplace_back(i, j); });
    return order;
  };
  // All pairs of leaves, from two poses; a part of them comes in the same order.
  const auto all = sequence(Pose::Identity(), 10);
  EXPECT_EQ(all, sequence(random.pose(1), 10));
  const auto some = sequence(makePose({0.21, 0, 0}), 0.01);
  ASSERT_FALSE(some.empty());
  auto place = all.begin();
  for (const auto& pair : some) {
    place = std::find(place, all.end(), pair);
    ASSERT_NE(place, all.end());
  }
}

TEST(VisitLeaves, FindsWhatMeetsTheBox) {
  RandomShapes random(6);
  const TriangleMesh mesh = triangleSoup(random, 1000);
  const Bvh tree(mesh);
  for (int trial = 0; trial < 200; ++trial) {
    Box box(random.point(1));
    box.extend(box.min() + random.point(0.3));
    std::set<std::uint32_t> found;
    visitLeaves(tree, box, [&](std::uint32_t leaf) {
      const Bvh::Node& node = tree.nodes()[leaf];
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) ASSERT_TRUE(found.insert(tree.order()[i]).second);
    });
    EXPECT_LT(found.size(), mesh.elements.size() / 2);
    for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
      Box element;
      for (const Vector3& corner : triangleOf(mesh, i)) element.extend(corner);
      if (box.intersects(element)) {
        ASSERT_TRUE(found.count(static_cast<std::uint32_t>(i)));
      }
    }
  }
  visitLeaves(tree, Box(), [](std::uint32_t) { ADD_FAILURE() << "an empty box meets nothing"; });
}

TEST(VisitLeavesBelowPlane, FindsEveryVertexBelow) {
  RandomShapes random(8);
  const TriangleMesh mesh = triangleSoup(random, 1000);
  const Bvh tree(mesh);
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3 n = random.point(1).normalized();
    const double d = random.uniform(-1.5, 0.5), margin = random.uniform(0, 0.1);
    std::set<std::uint32_t> found;
    visitLeavesBelowPlane(tree, n, d, margin, [&](std::uint32_t leaf) {
      const Bvh::Node& node = tree.nodes()[leaf];
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) ASSERT_TRUE(found.insert(tree.order()[i]).second);
    });
    for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
      for (const Vector3& corner : triangleOf(mesh, i)) {
        if (n.dot(corner) - d <= margin) {
          ASSERT_TRUE(found.count(static_cast<std::uint32_t>(i)));
        }
      }
    }
  }
  visitLeavesBelowPlane(tree, Vector3(0, 0, 1), -10, 0.1, [](std::uint32_t) { ADD_FAILURE() << "nothing is down there"; });
}

TEST(DistanceToMesh, IsTheLeastOverAllElements) {
  RandomShapes random(10);
  for (const TriangleMesh& mesh : {triangleSoup(random, 500), bumpySphere(random, 3), segmentMesh({0, 0, 0}, {1, 0, 0})}) {
    const Bvh tree(mesh);
    for (int trial = 0; trial < 300; ++trial) {
      const Vector3 p = random.point(1.5);
      double expected = std::numeric_limits<double>::infinity();
      for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
        expected = std::min(expected, closestPointTriangle(p, triangleOf(mesh, i)).distance);
      }
      ASSERT_EQ(distanceToMesh(tree, mesh, p), expected);
    }
  }
}

}  // namespace
}  // namespace blem_sim::geometry
