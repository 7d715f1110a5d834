#include <utility>

#include "blem_sim/geometry/far_origin.h"
#include "blem_sim/sim/simulator_types.h"

namespace blem_sim::sim {
namespace {

CloudSurface surfaceOf(model::LoadedSurface loaded) {
  CloudSurface surface;
  surface.radius = loaded.radius;
  surface.report = loaded.report;
  surface.origin = geometry::farOrigin(loaded.mesh->bounds());
  if (!surface.origin.isZero(0))
    loaded.mesh = std::make_shared<const geometry::TriangleMesh>(geometry::transformed(*loaded.mesh, makePose(-surface.origin)));
  surface.geometry = std::make_shared<const contact::CollisionGeometry>(loaded.mesh, loaded.topology);
  return surface;
}

}  // namespace

CloudSurface makeCloudSurface(model::SensedCloud cloud, const model::CloudOptions& options, const std::string& name) {
  return surfaceOf(model::cloudSurface(std::move(cloud), options, name));
}

CloudSurface makeMeshSurface(geometry::TriangleMesh mesh, const std::string& name) {
  return surfaceOf(model::meshSurface(std::move(mesh), name));
}

}  // namespace blem_sim::sim
