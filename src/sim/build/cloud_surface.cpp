#include "blem_sim/geometry/far_origin.h"
#include "blem_sim/sim/simulator_types.h"

namespace blem_sim::sim {

CloudSurface makeCloudSurface(std::vector<Vector3> points, const model::CloudOptions& cloud, const std::string& name) {
  model::LoadedSurface loaded = model::cloudSurface(std::move(points), cloud, name);
  CloudSurface surface;
  surface.radius = loaded.radius;
  surface.report = loaded.report;
  surface.origin = geometry::farOrigin(loaded.mesh->bounds());
  if (!surface.origin.isZero(0))
    loaded.mesh = std::make_shared<const geometry::TriangleMesh>(geometry::transformed(*loaded.mesh, makePose(-surface.origin)));
  surface.geometry = std::make_shared<const contact::CollisionGeometry>(loaded.mesh);
  return surface;
}

}  // namespace blem_sim::sim
