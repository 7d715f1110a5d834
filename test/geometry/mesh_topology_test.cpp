#include "blem_sim/geometry/mesh_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "geometry/random_shapes.h"

namespace blem_sim::geometry {
namespace {

/** Number of those from 0 to `count` - 1 for which a predicate holds. */
template <typename Holds>
int countOf(int count, Holds&& holds) {
  int found = 0;
  for (int i = 0; i < count; ++i) found += holds(i);
  return found;
}

int flatEdges(const MeshTopology& topology) {
  return countOf(topology.edgeCount(), [&](int edge) { return topology.isFlatEdge(edge); });
}

int flatVertices(const TriangleMesh& mesh, const MeshTopology& topology) {
  return countOf(static_cast<int>(mesh.vertices.size()), [&](int vertex) { return topology.isFlatVertex(vertex); });
}

int straightVertices(const TriangleMesh& mesh, const MeshTopology& topology) {
  return countOf(static_cast<int>(mesh.vertices.size()), [&](int vertex) { return topology.isStraightVertex(vertex); });
}

/** Edges with their faces, and the edges of vertices, found the plain way. */
struct PlainTopology {
  explicit PlainTopology(const TriangleMesh& mesh) : rings(mesh.vertices.size()) {
    std::map<std::array<int, 2>, std::vector<int>> faces_of;
    for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
      std::set<std::array<int, 2>> sides;
      for (int k = 0; k < 3; ++k) {
        const int from = mesh.elements[i][k], to = mesh.elements[i][(k + 1) % 3];
        if (from != to) sides.insert({std::min(from, to), std::max(from, to)});
      }
      for (const auto& side : sides) {
        std::vector<int>& faces_there = faces_of[side];
        if (!MeshTopology::normal(mesh, i).isZero(0)) faces_there.push_back(i);
      }
    }
    for (const auto& [ends, faces_there] : faces_of) {
      for (const int vertex : ends) rings[vertex].push_back(static_cast<int>(edges.size()));
      edges.push_back(ends);
      faces.push_back(faces_there);
    }
  }

  std::vector<std::array<int, 2>> edges;
  std::vector<std::vector<int>> faces, rings;
};

int ownedVertices(const TriangleMesh& mesh, const MeshTopology& topology) {
  int owned = 0;
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
    for (int k = 0; k < 3; ++k) owned += topology.ownsVertex(i, k);
  }
  return owned;
}

int ownedEdges(const TriangleMesh& mesh, const MeshTopology& topology) {
  int owned = 0;
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
    for (int k = 0; k < 3; ++k) owned += topology.ownsEdge(i, k);
  }
  return owned;
}

std::vector<int> patchesOf(const TriangleMesh& mesh, const MeshTopology& topology) {
  std::vector<int> patches;
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) patches.push_back(topology.patchOf(i));
  return patches;
}

/** Expects of any mesh's topology that it is as the plain way finds it. */
void expectConsistent(const TriangleMesh& mesh, const MeshTopology& topology) {
  const PlainTopology plain(mesh);
  ASSERT_EQ(topology.edgeCount(), static_cast<int>(plain.edges.size()));
  for (int edge = 0; edge < topology.edgeCount(); ++edge) {
    const EdgeFaces faces = topology.facesOf(edge);
    EXPECT_EQ(topology.ends(mesh, edge), plain.edges[edge]);
    EXPECT_EQ(std::vector<int>(faces.begin(), faces.end()), plain.faces[edge]);
    for (int k = 0; k < 2; ++k) EXPECT_EQ(topology.otherEnd(mesh, edge, plain.edges[edge][k]), plain.edges[edge][1 - k]);
  }
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const int from = mesh.elements[i][k], to = mesh.elements[i][(k + 1) % 3], edge = topology.edgeOf(static_cast<int>(i), k);
      if (from == to) {
        EXPECT_EQ(edge, MeshTopology::NO_EDGE);
      } else {
        EXPECT_EQ(topology.ends(mesh, edge), (std::array<int, 2>{std::min(from, to), std::max(from, to)}));
      }
    }
  }
  EXPECT_EQ(ownedVertices(mesh, topology),
            static_cast<int>(mesh.vertices.size()) - flatVertices(mesh, topology) - straightVertices(mesh, topology));
  EXPECT_EQ(ownedEdges(mesh, topology), topology.edgeCount() - flatEdges(topology));
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    const VertexEdges ring = topology.edgesOf(v);
    EXPECT_EQ(std::vector<int>(ring.begin(), ring.end()), plain.rings[v]);
    EXPECT_EQ(ring.empty(), plain.rings[v].empty());
  }
}

TEST(MeshTopology, CubeOwnsItsCornersAndEdges) {
  for (const int level : {0, 1, 3}) {
    const TriangleMesh mesh = subdivided(boxMesh({1, 2, 3}), level);
    const MeshTopology topology(mesh);
    expectConsistent(mesh, topology);
    const int n = 1 << level;
    EXPECT_EQ(topology.edgeCount(), 18 * n * n);
    EXPECT_EQ(ownedEdges(mesh, topology), 12 * n);
    EXPECT_EQ(ownedVertices(mesh, topology), 8);
    EXPECT_EQ(straightVertices(mesh, topology), 12 * (n - 1));
    for (int i = 0; i < topology.edgeCount(); ++i) EXPECT_EQ(topology.facesOf(i).size(), 2);
    std::vector<int> patches = patchesOf(mesh, topology);
    std::sort(patches.begin(), patches.end());
    EXPECT_EQ(std::unique(patches.begin(), patches.end()) - patches.begin(), 6);
  }
}

TEST(MeshTopology, GridOwnsItsOutlineAndCorners) {
  const TriangleMesh mesh = gridMesh(1, 2, 5, 7);
  const MeshTopology topology(mesh);
  expectConsistent(mesh, topology);
  EXPECT_EQ(ownedEdges(mesh, topology), 24);
  EXPECT_EQ(ownedVertices(mesh, topology), 4);
  EXPECT_EQ(patchesOf(mesh, topology), std::vector<int>(mesh.elements.size(), 0));
}

TEST(MeshTopology, InwardDirectionsPointIntoTheirFaces) {
  RandomShapes random(61);
  TriangleMesh mesh = gridMesh(1, 1, 4, 4);
  for (Vector3& v : mesh.vertices) v += random.point(0.05);
  const MeshTopology topology(mesh);
  for (int edge = 0; edge < topology.edgeCount(); ++edge) {
    const auto [start, end] = topology.ends(mesh, edge);
    const Vector3 a = mesh.vertices[start], b = mesh.vertices[end];
    EXPECT_FALSE(topology.isFlatEdge(edge));
    for (const int face : topology.facesOf(edge)) {
      const Vector3 u = topology.inward(mesh, edge, face);
      const Vector3i& e = mesh.elements[face];
      EXPECT_NEAR(u.norm(), 1, 1e-12);
      EXPECT_NEAR(u.dot(b - a), 0, 1e-12);
      EXPECT_NEAR(u.dot(MeshTopology::normal(mesh, face)), 0, 1e-12);
      EXPECT_GT(u.dot((mesh.vertices[e[0]] + mesh.vertices[e[1]] + mesh.vertices[e[2]]) / 3 - a), 0);
    }
  }
}

TEST(MeshTopology, FinOnAPlaneIsAnEdgeOfThree) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0}, {0.5, 0, 1}};
  mesh.elements = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  const MeshTopology topology(mesh);
  expectConsistent(mesh, topology);
  EXPECT_EQ(topology.facesOf(topology.edgeOf(0, 0)).size(), 3);
  EXPECT_EQ(flatEdges(topology), 0);
  mesh.elements.pop_back();
  EXPECT_EQ(flatEdges(MeshTopology(mesh)), 1);
}

TEST(MeshTopology, FoldedSheetIsNotFlatAndRepeatedFacesDoNotMatter) {
  TriangleMesh folded;
  folded.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.4, 0.9, 0}};
  folded.elements = {{0, 1, 2}, {0, 1, 3}};
  EXPECT_EQ(flatEdges(MeshTopology(folded)), 0);
  TriangleMesh twice = gridMesh(1, 1, 3, 3);
  const int flat = flatEdges(MeshTopology(twice));
  const std::vector<Vector3i> once = twice.elements;
  for (const Vector3i& e : once) twice.elements.push_back({e[1], e[0], e[2]});
  EXPECT_EQ(flatEdges(MeshTopology(twice)), flat);
}

TEST(MeshTopology, SegmentsPointsAndSliversAreNoFaces) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
  mesh.elements = {{0, 1, 1}, {3, 3, 3}, {0, 1, 2}};
  const MeshTopology topology(mesh);
  expectConsistent(mesh, topology);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(topology.isFace(i));
  EXPECT_EQ(topology.edgeCount(), 3);
  for (int edge = 0; edge < 3; ++edge) EXPECT_EQ(topology.facesOf(edge).size(), 0);
  EXPECT_EQ(ownedVertices(mesh, topology), 3);  // vertex 1 lies inside the edge from 0 to 2
  EXPECT_EQ(ownedEdges(mesh, topology), 3);
  EXPECT_TRUE(topology.ownsVertex(1, 0));
  EXPECT_TRUE(topology.ownsEdge(0, 0));
}

TEST(MeshTopology, WindingAndOrderDoNotChangeWhatIsFlat) {
  TriangleMesh mesh = subdivided(boxMesh({1, 1, 1}), 2);
  const TriangleMesh given = mesh;
  const MeshTopology straight(mesh);
  for (std::size_t i = 0; i < mesh.elements.size(); i += 2) std::swap(mesh.elements[i][0], mesh.elements[i][1]);
  std::reverse(mesh.elements.begin(), mesh.elements.end());
  const MeshTopology turned(mesh);
  ASSERT_EQ(straight.edgeCount(), turned.edgeCount());
  for (int edge = 0; edge < straight.edgeCount(); ++edge) {
    EXPECT_EQ(straight.ends(given, edge), turned.ends(mesh, edge));
    EXPECT_EQ(straight.isFlatEdge(edge), turned.isFlatEdge(edge));
  }
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) EXPECT_EQ(straight.isFlatVertex(v), turned.isFlatVertex(v));
}

TEST(MeshTopology, EdgesOfAnyNumberOfFacesAmongPiecesWithoutArea) {
  RandomShapes random(17);
  for (int round = 0; round < 30; ++round) {
    TriangleMesh mesh;
    const int vertices = random.integer(2, 12);
    for (int i = 0; i < vertices; ++i) mesh.vertices.push_back(random.point(1));
    if (round % 2 == 1) mesh.vertices.back() = 0.5 * (mesh.vertices[0] + mesh.vertices[1]);  // slivers
    const auto any = [&] { return random.integer(0, vertices - 1); };
    for (int i = 0; i < 40; ++i) mesh.elements.emplace_back(any(), any(), any());
    expectConsistent(mesh, MeshTopology(mesh));
  }
}

TEST(MeshTopology, EmptyMesh) {
  const MeshTopology topology((TriangleMesh()));
  EXPECT_EQ(topology.edgeCount(), 0);
}

}  // namespace
}  // namespace blem_sim::geometry
