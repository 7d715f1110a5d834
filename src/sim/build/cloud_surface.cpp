#include <tbb/task_arena.h>

#include <algorithm>
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

/** Calls make() with all processors but one, which the steps have: threads that come and go there would cool its caches. */
template <typename Make>
CloudSurface madeBesideSteps(const Make& make) {
  tbb::task_arena arena(std::max(1, tbb::this_task_arena::max_concurrency() - 1));
  CloudSurface surface;
  arena.execute([&] { surface = make(); });
  return surface;
}

}  // namespace

CloudSurface makeCloudSurface(model::SensedCloud cloud, const model::CloudOptions& options, const std::string& name) {
  return madeBesideSteps([&] { return surfaceOf(model::cloudSurface(std::move(cloud), options, name)); });
}

CloudSurface makeMeshSurface(geometry::TriangleMesh mesh, const std::string& name) {
  return madeBesideSteps([&] { return surfaceOf(model::meshSurface(std::move(mesh), name)); });
}

}  // namespace blem_sim::sim
