#include "publishers/markers/layer_markers.h"

#include <algorithm>
#include <cmath>

#include "blem_sim/sim/drawing.h"
#include "messages/conversions.h"

namespace blem_sim::node {

namespace {

using geometry::MeshTopology;
using geometry::TriangleMesh;
using visualization_msgs::Marker;

constexpr double FARTHEST = 2;  // of the width, that a vertex moves
constexpr float SHELL_ALPHA = 0.3F;
constexpr sim::Colour SHELL_TINT{0.3F, 0.5F, 1.0F};
constexpr double SHELL_TINTED = 0.6;

/** Whether a face goes along an edge from its lower vertex to its higher one. */
bool goesUp(const TriangleMesh& mesh, const MeshTopology& topology, int face, int edge) {
  const Vector3i& corners = mesh.elements[face];
  int k = 0;
  while (topology.edgeOf(face, k) != edge) ++k;
  return corners[k] < corners[(k + 1) % 3];
}

/** Neighbourhood of a mesh's faces. */
struct Winding {
  bool alike = true;   ///< no edge has more than two faces, and two go along it in opposite directions
  bool closed = true;  ///< no edge has one face
};

Winding windingOf(const TriangleMesh& mesh, const MeshTopology& topology) {
  Winding winding;
  for (int edge = 0; edge < topology.edgeCount(); ++edge) {
    const geometry::EdgeFaces faces = topology.facesOf(edge);
    if (faces.size() == 1) winding.closed = false;
    if (faces.size() > 2) winding.alike = false;
    if (faces.size() == 2 && goesUp(mesh, topology, faces[0], edge) == goesUp(mesh, topology, faces[1], edge)) winding.alike = false;
  }
  return winding;
}

double cornerAngle(const TriangleMesh& mesh, const Vector3i& face, int k) {
  const Vector3& corner = mesh.vertices[face[k]];
  const Vector3 a = mesh.vertices[face[(k + 1) % 3]] - corner, b = mesh.vertices[face[(k + 2) % 3]] - corner;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/** Per vertex the way that moves its faces' planes by 1, or nearly so; zero where faces face each other. */
std::vector<Vector3> waysOut(const TriangleMesh& mesh, const MeshTopology& topology) {
  std::vector<Vector3> ways(mesh.vertices.size(), Vector3::Zero());
  std::vector<double> least(mesh.vertices.size(), 1);  // of the way along the faces' normals
  const auto visit = [&](auto act) {
    for (int face = 0; face < static_cast<int>(mesh.elements.size()); ++face) {
      if (!topology.isFace(face)) continue;
      for (int k = 0; k < 3; ++k) act(face, k, mesh.elements[face][k]);
    }
  };
  visit([&](int face, int k, int vertex) { ways[vertex] += cornerAngle(mesh, mesh.elements[face], k) * MeshTopology::normal(mesh, face); });
  for (Vector3& way : ways) way = way.norm() > 0 ? Vector3(way.normalized()) : Vector3::Zero();
  visit([&](int face, int, int vertex) { least[vertex] = std::min(least[vertex], ways[vertex].dot(MeshTopology::normal(mesh, face))); });
  for (std::size_t i = 0; i < ways.size(); ++i) ways[i] /= std::max(1 / FARTHEST, least[i]);
  return ways;
}

double sixVolumes(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Vector3i& e : mesh.elements) sum += mesh.vertices[e[0]].dot(mesh.vertices[e[1]].cross(mesh.vertices[e[2]]));
  return sum;
}

/** Adds a mesh's faces, each corner moved. @param way of a corner (face, vertex) [m] */
template <typename Way>
void addMoved(const TriangleMesh& mesh, const MeshTopology& topology, const Way& way, TriangleMesh* shell) {
  for (int face = 0; face < static_cast<int>(mesh.elements.size()); ++face) {
    if (!topology.isFace(face)) continue;
    const int first = static_cast<int>(shell->vertices.size());
    for (int k = 0; k < 3; ++k) {
      const int vertex = mesh.elements[face][k];
      shell->vertices.push_back(mesh.vertices[vertex] + way(face, vertex));
    }
    shell->elements.emplace_back(first, first + 1, first + 2);
  }
}

}  // namespace

TriangleMesh movedShell(const TriangleMesh& mesh, const MeshTopology& topology, double r) {
  const Winding winding = windingOf(mesh, topology);
  const bool one_side = winding.alike && winding.closed;
  const std::vector<Vector3> ways = winding.alike ? waysOut(mesh, topology) : std::vector<Vector3>();
  TriangleMesh shell;
  const auto addSide = [&](double width) {
    addMoved(
        mesh, topology,
        [&](int face, int vertex) -> Vector3 { return width * (ways.empty() ? MeshTopology::normal(mesh, face) : ways[vertex]); }, &shell);
  };
  addSide(one_side && sixVolumes(mesh) < 0 ? -r : r);
  if (!one_side) addSide(-r);
  return shell;
}

std::vector<Marker> layerMarkers(const contact::Collider& collider, MarkerStyle style) {
  std::vector<Marker> markers;
  const bool ends_at_surface = collider.outside != nullptr;  // the layer lies inside, and its shell would flicker with what is drawn
  if (collider.geometry->isHalfSpace() || !(collider.radius > 0) || ends_at_surface) return markers;
  style.colour = toColour(sim::mixed({style.colour.r, style.colour.g, style.colour.b}, SHELL_TINT, SHELL_TINTED));
  style.colour.a = SHELL_ALPHA;
  addTriangles(movedShell(collider.geometry->mesh(), collider.geometry->topology(), collider.radius), markerOf(collider, style), &markers);
  return markers;
}

}  // namespace blem_sim::node
