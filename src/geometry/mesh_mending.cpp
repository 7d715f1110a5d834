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
  if (mesh->bounds().diagonal().norm() <= CRACK_WIDTH) return false;  // all of it fits into a crack
  const std::vector<Border> borders = bordersOf(*mesh, topology);
  if (borders.empty()) return false;
  VertexClusters clusters(static_cast<int>(mesh->vertices.size()));
  joinMatching(*mesh, topology, borders, &clusters, what);
  std::optional<TriangleMesh> matched;
  std::optional<MeshTopology> matched_topology;
  if (what->cracks > 0) matched_topology.emplace(matched.emplace(clusters.applied(*mesh, mesh->vertices)));
  const TriangleMesh& current = matched ? *matched : *mesh;
  const MeshTopology& current_topology = matched ? *matched_topology : topology;
  const std::vector<Border> left = matched ? bordersOf(current, current_topology) : borders;
  const std::vector<EdgeSplit> splits = joinOverlapping(current, current_topology, left, &clusters, what);
  if (what->cracks == 0 && splits.empty()) return false;
  std::size_t lost = mesh->elements.size() - current.elements.size();
  const TriangleMesh split = splitMesh(current, splits, what);
  const TriangleMesh joined = clusters.applied(split, mesh->vertices);
  lost += split.elements.size() - joined.elements.size();
  const std::vector<double> spreads = clusters.spreads(joined, mesh->vertices);
  *mesh = recleaned(joined, static_cast<int>(lost), report);
  *noise = kept(spreads, joined, *mesh);
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
