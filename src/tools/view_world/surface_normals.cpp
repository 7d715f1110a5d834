#include "surface_normals.h"

#include <cmath>

namespace blem_sim {

namespace {

const double SMOOTH = std::cos(40 * 3.14159265358979323846 / 180);

/** Twice the area, along the normal. */
Vector3 areaVector(const geometry::TriangleMesh& mesh, const Vector3i& e) {
  return (mesh.vertices[e[1]] - mesh.vertices[e[0]]).cross(mesh.vertices[e[2]] - mesh.vertices[e[0]]);
}

/** Triangles of each vertex. */
std::vector<std::vector<int>> facesByVertex(const geometry::TriangleMesh& mesh) {
  std::vector<std::vector<int>> faces(mesh.vertices.size());
  for (std::size_t face = 0; face < mesh.elements.size(); ++face)
    for (int corner = 0; corner < 3; ++corner) faces[mesh.elements[face][corner]].push_back(static_cast<int>(face));
  return faces;
}

}  // namespace

std::vector<Vector3> cornerNormals(const geometry::TriangleMesh& mesh) {
  const std::vector<std::vector<int>> faces = facesByVertex(mesh);
  std::vector<Vector3> areas, normals;
  for (const Vector3i& element : mesh.elements) areas.push_back(areaVector(mesh, element));
  for (std::size_t face = 0; face < mesh.elements.size(); ++face) {
    const Vector3 own = areas[face].normalized();
    for (int corner = 0; corner < 3; ++corner) {
      Vector3 sum = Vector3::Zero();
      for (const int other : faces[mesh.elements[face][corner]]) {
        const double along = own.dot(areas[other]);
        if (std::abs(along) >= SMOOTH * areas[other].norm()) sum += along > 0 ? areas[other] : Vector3(-areas[other]);
      }
      normals.push_back(sum.normalized());
    }
  }
  return normals;
}

}  // namespace blem_sim
