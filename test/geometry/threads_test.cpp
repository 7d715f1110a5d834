// Loading by one thread and by several gives the same bits.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cstring>
#include <map>

#include "blem_sim/geometry/bvh.h"
#include "blem_sim/geometry/collected.h"
#include "blem_sim/geometry/mesh_mending.h"
#include "blem_sim/geometry/mesh_topology.h"
#include "geometry/random_shapes.h"
#include "threads/disjoint_sets.h"
#include "threads/first_equals.h"
#include "threads/grouped.h"

namespace blem_sim::geometry {
namespace {

/** Triangles with corners of their own, in no order, some of them twice; enough of them for several threads to share. */
TriangleMesh largeSoup() {
  RandomShapes random(11);
  TriangleMesh grid = gridMesh(1, 1, 150, 150);
  for (Vector3& v : grid.vertices) v.z() = random.integer(0, 3) == 0 ? 0 : random.uniform(-1e-3, 1e-3);
  std::vector<Vector3i> elements = grid.elements;
  for (int i = 0; i < 500; ++i) elements.push_back(elements[random.integer(0, static_cast<int>(elements.size()) - 1)]);
  for (std::size_t i = elements.size() - 1; i > 0; --i) std::swap(elements[i], elements[random.integer(0, static_cast<int>(i))]);
  TriangleMesh soup;
  for (const Vector3i& e : elements) {
    const int first = static_cast<int>(soup.vertices.size());
    for (int k = 0; k < 3; ++k) soup.vertices.push_back(grid.vertices[e[k]]);
    soup.elements.emplace_back(first, first + 1, first + 2);
  }
  return soup;
}

struct Loaded {
  TriangleMesh mesh;
  MeshTopology topology;
  Bvh tree;
  MeshReport report;
};

Loaded loaded(const TriangleMesh& soup, int threads) {
  Loaded result;
  tbb::task_arena arena(threads);
  arena.execute([&] {
    result.mesh = mendMesh(cleanMesh(soup, &result.report), &result.report);
    result.topology = MeshTopology(result.mesh);
    result.tree = Bvh(result.mesh);
  });
  return result;
}

template <typename T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/** All numbers that a topology tells. */
std::vector<int> told(const Loaded& loaded) {
  const TriangleMesh& mesh = loaded.mesh;
  const MeshTopology& topology = loaded.topology;
  std::vector<int> all{topology.edgeCount()};
  const auto add = [&all](const auto& values) { all.insert(all.end(), values.begin(), values.end()); };
  for (int edge = 0; edge < topology.edgeCount(); ++edge) {
    add(topology.ends(mesh, edge));
    add(topology.facesOf(edge));
    all.push_back(topology.isFlatEdge(edge));
  }
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    add(topology.edgesOf(v));
    all.push_back(topology.isFlatVertex(v) + 2 * topology.isStraightVertex(v));
  }
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
    for (int k = 0; k < 3; ++k) all.push_back(topology.edgeOf(i, k));
    add(std::array<int, 4>{topology.isFace(i), topology.ownedVertices(i), topology.ownedEdges(i), topology.patchOf(i)});
  }
  return all;
}

TEST(Threads, NumberDoesNotShowInMeshTopologyAndTree) {
  const TriangleMesh soup = largeSoup();
  const Loaded one = loaded(soup, 1);
  EXPECT_EQ(one.report.duplicate, 500);
  EXPECT_EQ(one.mesh.vertices.size(), 151u * 151u);
  for (const int threads : {2, 2}) {
    const Loaded several = loaded(soup, threads);
    EXPECT_TRUE(sameBits(one.mesh.vertices, several.mesh.vertices));
    EXPECT_TRUE(sameBits(one.mesh.elements, several.mesh.elements));
    EXPECT_EQ(one.report.open_edges, several.report.open_edges);
    EXPECT_EQ(one.report.welded, several.report.welded);
    EXPECT_EQ(told(one), told(several));
    EXPECT_TRUE(sameBits(one.tree.nodes(), several.tree.nodes()));
    EXPECT_TRUE(sameBits(one.tree.order(), several.tree.order()));
  }
}

TEST(Threads, ArraysHaveNoSlack) {
  const Loaded loaded_mesh = loaded(largeSoup(), 2);
  const TriangleMesh& mesh = loaded_mesh.mesh;
  EXPECT_EQ(mesh.bytes(), mesh.vertices.size() * sizeof(Vector3) + mesh.elements.size() * sizeof(Vector3i));
  EXPECT_EQ(loaded_mesh.tree.bytes(), loaded_mesh.tree.nodes().size() * sizeof(Bvh::Node) + 4 * mesh.elements.size());
}

TEST(Threads, OfEqualItemsTheFirstIsFound) {
  RandomShapes random(3);
  std::vector<int> items(20000);
  for (int& item : items) item = random.integer(0, 6000);
  const std::vector<int> first = firstEquals(
      static_cast<int>(items.size()), [&](int i) { return static_cast<std::size_t>(items[i] % 1000); },  // hashes that collide
      [&](int i, int j) { return items[i] == items[j]; });
  std::map<int, int> expected;
  for (int i = 0; i < static_cast<int>(items.size()); ++i) ASSERT_EQ(first[i], expected.try_emplace(items[i], i).first->second);
}

TEST(Threads, ListsKeepTheOrderOfItems) {
  for (const int count : {0, 1, 1 << 14, 50000}) {
    const std::vector<int> list = collected<int>(count, [](int item, std::vector<int>* out) {
      for (int i = 0; i < item % 3; ++i) out->push_back(item);
    });
    std::vector<int> expected;
    for (int item = 0; item < count; ++item) expected.insert(expected.end(), static_cast<std::size_t>(item % 3), item);
    EXPECT_EQ(list, expected);
  }
}

TEST(Threads, SetsAreToldByTheirFirstItems) {
  constexpr int COUNT = 100000, RESIDUES = 77;
  RandomShapes random(5);
  std::vector<std::pair<int, int>> pairs;
  for (int i = RESIDUES; i < COUNT; ++i) pairs.emplace_back(i, i % RESIDUES + RESIDUES * random.integer(0, i / RESIDUES - 1));
  for (std::size_t i = pairs.size() - 1; i > 0; --i) std::swap(pairs[i], pairs[random.integer(0, static_cast<int>(i))]);
  DisjointSets sets(COUNT);
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t i) { sets.join(pairs[i].first, pairs[i].second); });
  for (int i = 0; i < COUNT; ++i) ASSERT_EQ(sets.first(i), i % RESIDUES);
}

TEST(Threads, GroupsKeepTheOrderOfItems) {
  RandomShapes random(4);
  for (const int count : {0, 1, 1000, 50000}) {
    std::vector<int> keys(count);
    for (int& key : keys) key = random.integer(0, 99);
    std::vector<int> values;
    const std::vector<int> begin = grouped(
        count, 100, [&](int item, auto&& visit) { visit(keys[item], item); },
        [&](std::size_t total) {
          values.resize(total);
          return values.data();
        });
    std::vector<int> expected;
    for (int key = 0; key < 100; ++key) {
      EXPECT_EQ(begin[key], static_cast<int>(expected.size()));
      for (int i = 0; i < count; ++i) {
        if (keys[i] == key) expected.push_back(i);
      }
    }
    EXPECT_EQ(values, expected);
    EXPECT_EQ(begin[100], count);
  }
}

}  // namespace
}  // namespace blem_sim::geometry
