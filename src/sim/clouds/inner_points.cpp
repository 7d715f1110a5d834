#include "clouds/inner_points.h"

#include <algorithm>
#include <limits>

#include "blem_sim/geometry/ray_cast.h"

namespace blem_sim::sim {
namespace {

constexpr int MOST_CROSSINGS = 1000;    // of a ray: beyond, the point counts as outside
constexpr double BEHIND_A_HIT = 1e-12;  // of the ray's range, where it goes on

bool isClosed(const contact::CollisionGeometry& geometry) {
  const geometry::MeshTopology& topology = geometry.topology();
  for (int edge = 0; edge < topology.edgeCount(); ++edge)
    if (topology.facesOf(edge).size() != 2) return false;
  return topology.edgeCount() > 0;
}

/** @param p [m] in the geometry's frame */
bool isInside(const contact::CollisionGeometry& geometry, const Vector3& p) {
  const geometry::Ray ray{p, Vector3(0.2638, 0.5179, 0.8137)};  // along nothing that things are built along
  geometry::RayRange range;
  int crossings = 0;
  while (crossings < MOST_CROSSINGS) {
    const geometry::RayHit hit = geometry::castRay({geometry.bvh(), geometry.mesh()}, ray, range);
    if (hit.element < 0) return crossings % 2 == 1;
    range.nearest = hit.t + BEHIND_A_HIT * (1 + hit.t);
    ++crossings;
  }
  return false;
}

/** Box in another frame that holds the box. */
Box turned(const Box& box, const Pose& X) {
  Box all;
  for (int corner = 0; corner < 8; ++corner) all.extend(X * box.corner(static_cast<Box::CornerType>(corner)));
  return all;
}

/** @param X_GC the cloud in the geometry's frame */
void addInside(const contact::CollisionGeometry& geometry, const contact::CollisionGeometry& cloud, const Pose& X_GC,
               std::vector<SunkPoint>* inner) {
  std::vector<int> candidates;
  geometry::visitLeaves(cloud.bvh(), turned(geometry.bounds(), X_GC.inverse()), [&](std::uint32_t leaf) {
    const geometry::Bvh::Node& node = cloud.bvh().nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Vector3i& element = cloud.mesh().elements[cloud.bvh().order()[i]];
      for (const int vertex : {element[0], element[1], element[2]})
        if (geometry.bounds().contains(X_GC * cloud.mesh().vertices[vertex])) candidates.push_back(vertex);
    }
  });
  if (candidates.empty() || !isClosed(geometry)) return;
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  for (const int vertex : candidates)
    if (isInside(geometry, X_GC * cloud.mesh().vertices[vertex])) inner->push_back({vertex, std::numeric_limits<double>::infinity()});
}

}  // namespace

std::vector<SunkPoint> innerPoints(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, int cloud) {
  std::vector<SunkPoint> inner;
  const contact::Collider& points = world.colliders[cloud];
  for (const contact::Collider& collider : world.colliders) {
    if (!collider.enabled || collider.body == dynamics::WORLD_BODY || collider.geometry->isHalfSpace()) continue;
    const Pose X_WG = bodies[collider.body].X_WB * collider.X_BC;
    addInside(*collider.geometry, *points.geometry, X_WG.inverse() * points.X_BC, &inner);
  }
  return inner;
}

}  // namespace blem_sim::sim
