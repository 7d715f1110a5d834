#include "surface_library.h"

#include <fmt/format.h>

namespace blem_sim {

SharedSurface SurfaceLibrary::load(const std::string& file, const Vector3& scale, const CloudOptions& cloud) {
  const std::string key = fmt::format("{}|{} {} {}|{} {} {}", file, scale.x(), scale.y(), scale.z(), static_cast<int>(cloud.as),
                                      cloud.point_radius, cloud.max_edge);
  Entry& entry = files_[key];
  if (const auto held = entry.geometry.lock()) return {held, entry.radius, entry.report};
  const LoadedSurface surface = loadSurface(file, scale, cloud, mending_);
  const auto made = geometry(surface.mesh);
  entry = {made, surface.radius, surface.report};
  return {made, surface.radius, surface.report};
}

std::shared_ptr<const CollisionGeometry> SurfaceLibrary::geometry(const std::shared_ptr<const TriangleMesh>& mesh) {
  std::weak_ptr<const CollisionGeometry>& held = meshes_[mesh.get()];
  if (auto known = held.lock()) return known;
  const auto made = std::make_shared<const CollisionGeometry>(mesh);
  held = made;
  return made;
}

}  // namespace blem_sim
