#include "layer_shell.h"

#include <array>

#include "blem_sim/geometry/shortest_turn.h"

namespace blem_sim {

namespace {

constexpr int ARC_STEPS = 6;
constexpr std::size_t MOST_FINE_CAPS = 1000;  // vertices of a mesh whose caps are fine

void addQuad(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d, geometry::TriangleMesh* shell) {
  const int first = static_cast<int>(shell->vertices.size());
  shell->vertices.insert(shell->vertices.end(), {a, b, c, d});
  shell->elements.emplace_back(first, first + 1, first + 2);
  shell->elements.emplace_back(first, first + 2, first + 3);
}

void addFace(const geometry::TriangleMesh& mesh, int face, const Vector3& away, geometry::TriangleMesh* shell) {
  const int first = static_cast<int>(shell->vertices.size());
  for (int corner = 0; corner < 3; ++corner) shell->vertices.push_back(mesh.vertices[mesh.elements[face][corner]] + away);
  shell->elements.emplace_back(first, first + 1, first + 2);
}

/** Part of a tube along an edge, from one unit direction to another by the shorter way. */
void addTube(const std::array<Vector3, 2>& ends, const Vector3& from, const Vector3& to, double r, geometry::TriangleMesh* shell) {
  const Quaternion turn = geometry::shortestTurn(from, to);
  Vector3 last = r * from;
  for (int step = 1; step <= ARC_STEPS; ++step) {
    const Vector3 next = r * (Quaternion::Identity().slerp(static_cast<double>(step) / ARC_STEPS, turn) * from);
    addQuad(ends[0] + last, ends[1] + last, ends[1] + next, ends[0] + next, shell);
    last = next;
  }
}

void addEdge(const geometry::TriangleMesh& mesh, const geometry::MeshTopology& topology, int edge, double r,
             geometry::TriangleMesh* shell) {
  const geometry::EdgeFaces faces = topology.facesOf(edge);
  const std::array<int, 2> vertices = topology.ends(mesh, edge);
  const std::array<Vector3, 2> ends{mesh.vertices[vertices[0]], mesh.vertices[vertices[1]]};
  if (faces.size() == 1) {
    const Vector3 normal = geometry::MeshTopology::normal(mesh, faces[0]);
    const Vector3 outward = -topology.inward(mesh, edge, faces[0]);
    addTube(ends, normal, outward, r, shell);
    addTube(ends, outward, -normal, r, shell);
  } else if (faces.size() == 2) {
    // Normals on the side where the edge stands out, whatever the windings.
    const auto side = [&](int face, int other) {
      const Vector3 normal = geometry::MeshTopology::normal(mesh, face);
      return normal.dot(topology.inward(mesh, edge, other)) > 0 ? Vector3(-normal) : normal;
    };
    addTube(ends, side(faces[0], faces[1]), side(faces[1], faces[0]), r, shell);
  }
}

/** Part of a ball that is nearer to a vertex than to all its edges. */
void addCap(const geometry::TriangleMesh& mesh, const geometry::MeshTopology& topology, int vertex, const geometry::TriangleMesh& ball,
            geometry::TriangleMesh* shell) {
  const Vector3& centre = mesh.vertices[vertex];
  for (const Vector3i& element : ball.elements) {
    const Vector3 outward = ball.vertices[element[0]] + ball.vertices[element[1]] + ball.vertices[element[2]];
    bool nearest = true;
    for (const int edge : topology.edgesOf(vertex))
      nearest = nearest && outward.dot(mesh.vertices[topology.otherEnd(mesh, edge, vertex)] - centre) <= 0;
    if (!nearest) continue;
    const int first = static_cast<int>(shell->vertices.size());
    for (int corner = 0; corner < 3; ++corner) shell->vertices.push_back(centre + ball.vertices[element[corner]]);
    shell->elements.emplace_back(first, first + 1, first + 2);
  }
}

}  // namespace

geometry::TriangleMesh layerShell(const geometry::TriangleMesh& mesh, const geometry::MeshTopology& topology, double r) {
  geometry::TriangleMesh shell;
  for (int element = 0; element < static_cast<int>(mesh.elements.size()); ++element) {
    if (!topology.isFace(element)) continue;
    const Vector3 away = r * geometry::MeshTopology::normal(mesh, element);
    addFace(mesh, element, away, &shell);
    addFace(mesh, element, -away, &shell);
  }
  for (int edge = 0; edge < topology.edgeCount(); ++edge) {
    if (!topology.isFlatEdge(edge)) addEdge(mesh, topology, edge, r, &shell);
  }
  const geometry::TriangleMesh ball = geometry::icosphereMesh(r, mesh.vertices.size() > MOST_FINE_CAPS ? 1 : 3);
  for (int vertex = 0; vertex < static_cast<int>(mesh.vertices.size()); ++vertex) {
    if (!topology.isFlatVertex(vertex) && !topology.isStraightVertex(vertex)) addCap(mesh, topology, vertex, ball, &shell);
  }
  return shell;
}

}  // namespace blem_sim
