#include "clouds/leaving_triangles.h"

#include <algorithm>
#include <map>

#include "blem_sim/geometry/bvh_traversal.h"

namespace blem_sim::sim {
namespace {

constexpr double BESIDE = 1e-5;  // [m] from where a contact touches: triangles no farther are touched as well

Box boxOfElement(const geometry::TriangleMesh& mesh, int element) {
  Box box;
  for (int corner = 0; corner < 3; ++corner) box.extend(mesh.vertices[mesh.elements[element][corner]]);
  return box;
}

}  // namespace

void visitTouched(const contact::Collider& mesh, const contact::MeshPlace& place, const Vector3& way,
                  const std::function<void(int element)>& visit) {
  const contact::CollisionGeometry& geometry = *mesh.geometry;
  Vector3 p = Vector3::Zero();
  for (int k = 0; k < 3; ++k) p += place.weights[k] * geometry.mesh().vertices[place.corners[k]];
  Box near(p);
  near.extend(p + mesh.X_BC.linear().transpose() * way);
  near = Box(near.min() - Vector3::Constant(BESIDE), near.max() + Vector3::Constant(BESIDE));
  geometry::visitLeaves(geometry.bvh(), near, [&](std::uint32_t leaf) {
    const geometry::Bvh::Node& node = geometry.bvh().nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const int element = static_cast<int>(geometry.bvh().order()[i]);
      if (boxOfElement(geometry.mesh(), element).intersects(near)) visit(element);
    }
  });
}

void LeavingTriangles::addTouched(int mesh, const contact::MeshPlace& place, const Vector3& way, double sink) {
  for (int k = 0; k < 3; ++k)
    if (place.weights[k] > 0) held_.emplace(mesh, place.corners[k]);
  visitTouched(colliders_[mesh], place, way, [&](int element) {
    double& known = touched_.emplace(std::make_pair(mesh, element), sink).first->second;
    known = std::max(known, sink);
  });
}

SunkSurface LeavingTriangles::surface(const Pose& X_CW, const FadingPoints& fading, double least) const {
  SunkSurface surface;
  for (const auto& touched : touched_) surface.radius = std::max(surface.radius, colliders_[touched.first.first].radius);
  std::map<std::pair<int, int>, int> vertices;  // by collider and vertex there
  for (const auto& [key, sink] : touched_) {
    const auto& [mesh, element] = key;
    const contact::Collider& collider = colliders_[mesh];
    const double thicker = surface.radius - collider.radius;
    Vector3i corners;
    for (int k = 0; k < 3; ++k) {
      const int vertex = collider.geometry->mesh().elements[element][k], next = static_cast<int>(surface.sunk.size());
      const auto [known, is_new] = vertices.emplace(std::make_pair(mesh, vertex), next);
      corners[k] = known->second;
      if (is_new) {
        surface.mesh.vertices.push_back(X_CW * (collider.X_BC * collider.geometry->mesh().vertices[vertex]));
        surface.sunk.push_back({next, std::max(least, thicker + fading.sinkOf(mesh, vertex))});
      }
      SunkPoint& point = surface.sunk[known->second];
      if (held_.count({mesh, vertex}) == 0) point.sink = std::max(point.sink, thicker + sink);
    }
    surface.mesh.elements.push_back(corners);
  }
  return surface;
}

}  // namespace blem_sim::sim
