#include "blem_sim/geometry/mesh_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "random_shapes.h"

namespace blem_sim {
namespace {

template <typename Flags>
int countOf(const Flags& flags) {
  return static_cast<int>(std::count_if(flags.begin(), flags.end(), [](auto flag) { return flag != 0; }));
}

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

int facesOf(const MeshTopology& topology, int edge) { return topology.edge_face_begin[edge + 1] - topology.edge_face_begin[edge]; }

/** What does not depend on the mesh: every list is sorted and every element's edges are its own. */
void expectConsistent(const TriangleMesh& mesh, const MeshTopology& topology) {
  ASSERT_EQ(topology.element_edges.size(), mesh.elements.size());
  EXPECT_TRUE(std::is_sorted(topology.edges.begin(), topology.edges.end()));
  EXPECT_TRUE(std::adjacent_find(topology.edges.begin(), topology.edges.end()) == topology.edges.end());
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const int from = mesh.elements[i][k], to = mesh.elements[i][(k + 1) % 3], edge = topology.element_edges[i][k];
      if (from == to) {
        EXPECT_EQ(edge, MeshTopology::NO_EDGE);
      } else {
        EXPECT_EQ(topology.edges[edge], (std::array<int, 2>{std::min(from, to), std::max(from, to)}));
      }
    }
  }
  EXPECT_EQ(ownedVertices(mesh, topology),
            static_cast<int>(mesh.vertices.size()) - countOf(topology.vertex_flat) - countOf(topology.vertex_straight));
  EXPECT_EQ(ownedEdges(mesh, topology), static_cast<int>(topology.edges.size()) - countOf(topology.edge_flat));
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    for (int i = topology.vertex_edge_begin[v]; i < topology.vertex_edge_begin[v + 1]; ++i) {
      const std::array<int, 2>& edge = topology.edges[topology.vertex_edges[i]];
      EXPECT_TRUE(edge[0] == v || edge[1] == v);
    }
  }
  EXPECT_EQ(topology.vertex_edges.size(), 2 * topology.edges.size());
}

TEST(MeshTopology, CubeOwnsItsCornersAndEdges) {
  for (const int level : {0, 1, 3}) {
    const TriangleMesh mesh = subdivided(boxMesh({1, 2, 3}), level);
    const MeshTopology topology(mesh);
    expectConsistent(mesh, topology);
    const int n = 1 << level;
    EXPECT_EQ(static_cast<int>(topology.edges.size()), 18 * n * n);
    EXPECT_EQ(ownedEdges(mesh, topology), 12 * n);
    EXPECT_EQ(ownedVertices(mesh, topology), 8);
    EXPECT_EQ(countOf(topology.vertex_straight), 12 * (n - 1));
    for (std::size_t i = 0; i < topology.edges.size(); ++i) EXPECT_EQ(facesOf(topology, i), 2);
    std::vector<int> patches = topology.patch;
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
  EXPECT_TRUE(std::all_of(topology.patch.begin(), topology.patch.end(), [](int patch) { return patch == 0; }));
}

TEST(MeshTopology, InwardDirectionsPointIntoTheirFaces) {
  RandomShapes random(61);
  TriangleMesh mesh = gridMesh(1, 1, 4, 4);
  for (Vector3& v : mesh.vertices) v += random.point(0.05);
  const MeshTopology topology(mesh);
  for (int edge = 0; edge < static_cast<int>(topology.edges.size()); ++edge) {
    const Vector3 a = mesh.vertices[topology.edges[edge][0]], b = mesh.vertices[topology.edges[edge][1]];
    EXPECT_FALSE(topology.edge_flat[edge]);
    for (int i = topology.edge_face_begin[edge]; i < topology.edge_face_begin[edge + 1]; ++i) {
      const int face = topology.edge_faces[i];
      const Vector3 u = topology.inward(mesh, edge, face);
      const Vector3i& e = mesh.elements[face];
      EXPECT_NEAR(u.norm(), 1, 1e-12);
      EXPECT_NEAR(u.dot(b - a), 0, 1e-12);
      EXPECT_NEAR(u.dot(topology.normals[face]), 0, 1e-12);
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
  EXPECT_EQ(facesOf(topology, topology.element_edges[0][0]), 3);
  EXPECT_EQ(countOf(topology.edge_flat), 0);
  mesh.elements.pop_back();
  EXPECT_EQ(countOf(MeshTopology(mesh).edge_flat), 1);
}

TEST(MeshTopology, FoldedSheetIsNotFlatAndRepeatedFacesDoNotMatter) {
  TriangleMesh folded;
  folded.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.4, 0.9, 0}};
  folded.elements = {{0, 1, 2}, {0, 1, 3}};
  EXPECT_EQ(countOf(MeshTopology(folded).edge_flat), 0);
  TriangleMesh twice = gridMesh(1, 1, 3, 3);
  const int flat = countOf(MeshTopology(twice).edge_flat);
  const std::vector<Vector3i> once = twice.elements;
  for (const Vector3i& e : once) twice.elements.push_back({e[1], e[0], e[2]});
  EXPECT_EQ(countOf(MeshTopology(twice).edge_flat), flat);
}

TEST(MeshTopology, SegmentsPointsAndSliversAreNoFaces) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
  mesh.elements = {{0, 1, 1}, {3, 3, 3}, {0, 1, 2}};
  const MeshTopology topology(mesh);
  expectConsistent(mesh, topology);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(topology.isFace(i));
  EXPECT_EQ(topology.edges.size(), 3u);
  EXPECT_TRUE(topology.edge_faces.empty());
  EXPECT_EQ(ownedVertices(mesh, topology), 3);  // vertex 1 lies inside the edge from 0 to 2
  EXPECT_EQ(ownedEdges(mesh, topology), 3);
  EXPECT_TRUE(topology.ownsVertex(1, 0));
  EXPECT_TRUE(topology.ownsEdge(0, 0));
}

TEST(MeshTopology, WindingAndOrderDoNotChangeWhatIsFlat) {
  TriangleMesh mesh = subdivided(boxMesh({1, 1, 1}), 2);
  const MeshTopology straight(mesh);
  for (std::size_t i = 0; i < mesh.elements.size(); i += 2) std::swap(mesh.elements[i][0], mesh.elements[i][1]);
  std::reverse(mesh.elements.begin(), mesh.elements.end());
  const MeshTopology turned(mesh);
  EXPECT_EQ(straight.edges, turned.edges);
  EXPECT_EQ(straight.edge_flat, turned.edge_flat);
  EXPECT_EQ(straight.vertex_flat, turned.vertex_flat);
}

TEST(MeshTopology, EmptyMesh) {
  const MeshTopology topology((TriangleMesh()));
  EXPECT_TRUE(topology.edges.empty());
}

}  // namespace
}  // namespace blem_sim
