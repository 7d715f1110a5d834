// The meshes of plain shapes. All are wound outwards.
#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/cylinder.h"
#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {

TriangleMesh boxMesh(const Vector3& size) {
  TriangleMesh mesh;
  // Corner i lies on the upper side of axis k where bit k of i is set.
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(0.5 * size.cwiseProduct(Vector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
  mesh.elements = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh cylinderMesh(double radius, double length, int sides) {
  TriangleMesh mesh;
  // Vertices 2 i and 2 i + 1 are the lower and upper end of line i of the mantle; the last two are the middles of the caps.
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * M_PI * i / sides;
    const double x = radius * std::cos(angle), y = radius * std::sin(angle);
    mesh.vertices.emplace_back(x, y, -0.5 * length);
    mesh.vertices.emplace_back(x, y, 0.5 * length);
  }
  const int bottom = 2 * sides, top = bottom + 1;
  mesh.vertices.emplace_back(0, 0, -0.5 * length);
  mesh.vertices.emplace_back(0, 0, 0.5 * length);
  for (int i = 0; i < sides; ++i) {
    const int lower = 2 * i, upper = lower + 1;
    const int next_lower = 2 * ((i + 1) % sides), next_upper = next_lower + 1;
    mesh.elements.emplace_back(lower, next_lower, next_upper);
    mesh.elements.emplace_back(lower, next_upper, upper);
    mesh.elements.emplace_back(bottom, next_lower, lower);
    mesh.elements.emplace_back(top, upper, next_upper);
  }
  return mesh;
}

std::optional<Cylinder> cylinderBehind(const TriangleMesh& mesh) {
  constexpr double SAME = 1e-9;  // of the radius and the length
  const std::size_t sides = mesh.elements.size() / 4;
  if (sides < 3 || mesh.elements.size() != 4 * sides || mesh.vertices.size() != 2 * sides + 2) return std::nullopt;
  const Vector3 bottom = mesh.vertices[2 * sides], top = mesh.vertices[2 * sides + 1], along = top - bottom;
  Cylinder cylinder;
  cylinder.sides = static_cast<int>(sides);
  cylinder.half_length = 0.5 * along.norm();
  cylinder.radius = (mesh.vertices[0] - bottom).norm();
  const Vector3 axis = along.normalized(), first = (mesh.vertices[0] - bottom).normalized();
  cylinder.X_GK.linear() << first, axis.cross(first), axis;
  cylinder.X_GK.translation() = 0.5 * (bottom + top);
  for (std::size_t v = 0; v < 2 * sides; ++v) {
    const double angle = 2 * M_PI * (v / 2) / sides, z = v % 2 == 0 ? -cylinder.half_length : cylinder.half_length;
    const Vector3 expected = cylinder.X_GK * Vector3(cylinder.radius * std::cos(angle), cylinder.radius * std::sin(angle), z);
    if (!((mesh.vertices[v] - expected).norm() < SAME * (cylinder.radius + cylinder.half_length))) return std::nullopt;
  }
  return cylinder;
}

double widestLayerInside(const Cylinder& cylinder) { return 0.5 * std::min(cylinder.radius, cylinder.half_length); }

CylinderCore coreOf(const TriangleMesh& mesh, const Cylinder& cylinder, double layer) {
  CylinderCore core{mesh, cylinder};
  core.cylinder.radius -= layer;
  core.cylinder.half_length -= layer;
  const double across = core.cylinder.radius / cylinder.radius, along = core.cylinder.half_length / cylinder.half_length;
  const Pose X_KG = cylinder.X_GK.inverse();
  for (Vector3& v : core.mesh.vertices) v = cylinder.X_GK * Vector3(across, across, along).cwiseProduct(X_KG * v);
  return core;
}

TriangleMesh gridMesh(double size_x, double size_y, int nx, int ny) {
  TriangleMesh mesh;
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) mesh.vertices.emplace_back(size_x * (double(i) / nx - 0.5), size_y * (double(j) / ny - 0.5), 0);
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int corner = j * (nx + 1) + i, above = corner + nx + 1;
      mesh.elements.emplace_back(corner, corner + 1, above + 1);
      mesh.elements.emplace_back(corner, above + 1, above);
    }
  }
  return mesh;
}

TriangleMesh icosphereMesh(double radius, int level) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.elements = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                   {3, 9, 4},  {3, 4, 2}, {3, 2, 6}, {3, 6, 8},  {3, 8, 9},   {4, 9, 5}, {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  // Onto the sphere after each halving: the triangles stay more even than with one projection at the end.
  for (int i = 0; i <= level; ++i) {
    if (i > 0) mesh = subdivided(mesh, 1);
    for (Vector3& v : mesh.vertices) v.normalize();
  }
  for (Vector3& v : mesh.vertices) v *= radius;
  return mesh;
}

TriangleMesh pointMesh(const Vector3& p) {
  TriangleMesh mesh;
  mesh.vertices = {p};
  mesh.elements = {{0, 0, 0}};
  return mesh;
}

TriangleMesh segmentMesh(const Vector3& p, const Vector3& q) {
  TriangleMesh mesh;
  mesh.vertices = {p, q};
  mesh.elements = {{0, 1, 1}};
  return mesh;
}

}  // namespace blem_sim::geometry
