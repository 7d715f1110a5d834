#include "blem_sim/geometry/mesh_mending.h"

#include <optional>
#include <utility>

#include "mesh_borders.h"
#include "mesh_planes.h"

namespace blem_sim::geometry {
namespace {

/** Cleans the mesh that joining has left, and brings the report up to date. */
TriangleMesh recleaned(const TriangleMesh& joined, int collapsed, MeshReport* report) {
  MeshReport after;
  TriangleMesh mesh = cleanMesh(joined, &after);
  report->degenerate += after.degenerate + collapsed;
  report->duplicate += after.duplicate;
  report->vertices = after.vertices;
  report->triangles = after.triangles;
  report->segments = after.segments;
  report->points = after.points;
  report->open_edges = after.open_edges;
  report->nonmanifold_edges = after.nonmanifold_edges;
  report->closed = after.closed;
  report->extents = after.extents;
  return mesh;
}

/** Values of the vertices that cleaning has kept, in their order. */
std::vector<double> kept(const std::vector<double>& values, const TriangleMesh& before, const TriangleMesh& after) {
  std::vector<double> kept;
  kept.reserve(after.vertices.size());
  for (std::size_t i = 0; i < values.size() && kept.size() < after.vertices.size(); ++i) {
    if (before.vertices[i] == after.vertices[kept.size()]) kept.push_back(values[i]);
  }
  return kept;
}

/** Joins and splits borders. @param noise of the vertices [m], where known from the vertices joined @return false if nothing was to be
 * done; then the mesh is as it was */
bool closeCracks(const MeshTopology& topology, TriangleMesh* mesh, std::vector<double>* noise, MeshReport* report, MeshMending* what) {
  const std::vector<Border> borders = bordersOf(*mesh, topology);
  if (borders.empty()) return false;
  const std::vector<Vector3> places = mesh->vertices;
  VertexClusters clusters(static_cast<int>(places.size()));
  joinMatching(*mesh, topology, borders, &clusters, what);
  std::optional<MeshTopology> joined_topology;
  const std::size_t given = mesh->elements.size();
  if (what->cracks > 0) {
    *mesh = clusters.applied(*mesh, places);
    joined_topology.emplace(*mesh);
  }
  const MeshTopology& current = joined_topology ? *joined_topology : topology;
  const std::vector<Border> left = joined_topology ? bordersOf(*mesh, current) : borders;
  const std::vector<EdgeSplit> splits = joinOverlapping(*mesh, current, left, &clusters, what);
  if (what->cracks == 0 && splits.empty()) return false;
  std::size_t lost = given - mesh->elements.size();
  const TriangleMesh split = splitMesh(*mesh, splits, what);
  const TriangleMesh joined = clusters.applied(split, places);
  lost += split.elements.size() - joined.elements.size();
  *mesh = recleaned(joined, static_cast<int>(lost), report);
  *noise = kept(clusters.spreads(joined, places), joined, *mesh);
  return true;
}

}  // namespace

TriangleMesh mendMesh(TriangleMesh mesh, MeshReport* report, MeshMending* what, MeshTopology* topology) {
  MeshReport unwanted_report;
  MeshMending unwanted;
  if (!report) report = &unwanted_report;
  if (!what) what = &unwanted;
  *what = MeshMending();
  MeshTopology unwanted_topology;
  if (!topology) topology = &unwanted_topology;
  *topology = MeshTopology(mesh);
  std::vector<double> noise;
  if (closeCracks(*topology, &mesh, &noise, report, what)) *topology = MeshTopology(mesh);
  flattenPlanes(*topology, noise, &mesh, what);
  if (what->flattened == 0) return mesh;
  report->extents = mesh.bounds();
  if (topology != &unwanted_topology) *topology = MeshTopology(mesh);
  return mesh;
}

}  // namespace blem_sim::geometry
