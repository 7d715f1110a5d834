// Edges with one triangle, and the vertices that mending makes one.
#pragma once

#include <vector>

#include "blem_sim/geometry/mesh_mending.h"
#include "blem_sim/geometry/mesh_topology.h"
#include "threads/disjoint_sets.h"

namespace blem_sim::geometry {

/** An edge with one triangle. */
struct Border {
  int face, side;    ///< from corner `side` of the face to the next one
  int a, b;          ///< its vertices
  double length;     ///< [m]
  Vector3 inward;    ///< unit, in the triangle's plane, square to the edge
  Vector3i corners;  ///< vertices of the triangle
};

std::vector<Border> bordersOf(const TriangleMesh& mesh, const MeshTopology& topology);

/** Whether the surface may go on from e to f: not if the triangles lie on one another, nor if they are neighbours already. */
bool mayContinue(const Border& e, const Border& f);

/** Largest distance [m] of the borders' ends for a join: CRACK_WIDTH, less for short edges. */
double reachOf(const Border& e, const Border& f);

/** Largest reach [m] of all pairs: what is further apart is not joined. Small for meshes of small triangles, of which many lie within
 *  CRACK_WIDTH. */
double longestReach(const std::vector<Border>& borders);

/** Whether two vertices are the ends of one edge of the mesh. */
bool areNeighbours(const TriangleMesh& mesh, const MeshTopology& topology, int vertex, int other);

/** Sets of vertices that become one, at the mean of their places. */
class VertexClusters {
 public:
  explicit VertexClusters(int vertices) : sets_(vertices) {}
  void join(int vertex, int other) { sets_.join(vertex, other); }

  /** The mesh with one vertex per cluster; triangles that lose a corner are dropped. @param places of the vertices before any joining */
  TriangleMesh applied(const TriangleMesh& mesh, const std::vector<Vector3>& places);
  /** [m] per vertex that stands for its cluster: distance of the farthest member's place from the joined one; 0 for the others.
   * @param joined the mesh from applied() */
  std::vector<double> spreads(const TriangleMesh& joined, const std::vector<Vector3>& places);

 private:
  DisjointSets sets_;
};

/** Joins the ends of borders that lie side by side from end to end. */
void joinMatching(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<Border>& borders, VertexClusters* clusters,
                  MeshMending* what);

/** A vertex on the inside of a border. */
struct EdgeSplit {
  int face, side;
  int vertex;
};

/** Joins ends and finds splits where borders overlap in part. */
std::vector<EdgeSplit> joinOverlapping(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<Border>& borders,
                                       VertexClusters* clusters, MeshMending* what);

/** The mesh with triangles cut from splits to the opposite corners; a split at a corner is none. */
TriangleMesh splitMesh(const TriangleMesh& mesh, std::vector<EdgeSplit> splits, MeshMending* what);

}  // namespace blem_sim::geometry
