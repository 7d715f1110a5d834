#include "drawn_shape.h"

#include <algorithm>

#include "blem_sim/geometry/shortest_turn.h"

namespace blem_sim {

namespace {

constexpr int ROUND_LEVEL = 2;      // of spheres: 320 triangles
constexpr int ROUND_SIDES = 24;     // of rods
constexpr double HEAD = 5;          // length of an arrow's head in thicknesses of its shaft
constexpr double HEAD_WIDTH = 1.5;  // radius of its head, likewise

/** Pose whose z axis runs along a direction. */
Pose alongZ(const Vector3& origin, const Vector3& direction) {
  Pose pose = Pose::Identity();
  pose.linear() = geometry::shortestTurn(Vector3::UnitZ(), direction).toRotationMatrix();
  pose.translation() = origin;
  return pose;
}

/** Cone about z with its base in z = 0. */
geometry::TriangleMesh coneMesh(double radius, double length) {
  geometry::TriangleMesh cone = geometry::cylinderMesh(radius, length, ROUND_SIDES);
  for (Vector3& vertex : cone.vertices) vertex = vertex.z() > 0 ? Vector3(0, 0, length) : Vector3(vertex.x(), vertex.y(), 0);
  return geometry::cleanMesh(cone, nullptr);
}

}  // namespace

void append(const geometry::TriangleMesh& mesh, geometry::TriangleMesh* to) {
  const int first = static_cast<int>(to->vertices.size());
  to->vertices.insert(to->vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const Vector3i& element : mesh.elements) to->elements.push_back(element + Vector3i::Constant(first));
}

void addColoured(const geometry::TriangleMesh& mesh, const sim::Colour& colour, DrawnShape* shape) {
  append(mesh, &shape->mesh);
  shape->colours.resize(shape->mesh.elements.size(), colour);
}

geometry::TriangleMesh arrowMesh(const Vector3& foot, const Vector3& along, double thickness) {
  const double length = along.norm();
  const double head = std::min(HEAD * thickness, 0.5 * length);
  const Vector3 neck = foot + (length - head) / length * along;
  geometry::TriangleMesh arrow =
      geometry::transformed(geometry::cylinderMesh(0.5 * thickness, length - head, ROUND_SIDES), alongZ(0.5 * (foot + neck), along));
  append(geometry::transformed(coneMesh(HEAD_WIDTH * thickness, head), alongZ(neck, along)), &arrow);
  return arrow;
}

geometry::TriangleMesh capsuleMesh(const Vector3& p, const Vector3& q, double radius) {
  const geometry::TriangleMesh end = geometry::icosphereMesh(radius, ROUND_LEVEL);
  geometry::TriangleMesh capsule =
      geometry::transformed(geometry::cylinderMesh(radius, (q - p).norm(), ROUND_SIDES), alongZ(0.5 * (p + q), q - p));
  for (const Vector3& centre : {p, q}) append(geometry::transformed(end, makePose(centre)), &capsule);
  return capsule;
}

}  // namespace blem_sim
