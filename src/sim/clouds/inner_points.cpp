#include "clouds/inner_points.h"

#include <algorithm>
#include <limits>

#include "blem_sim/geometry/bvh_traversal.h"
#include "blem_sim/geometry/closest_points.h"
#include "blem_sim/geometry/ray_cast.h"
#include "clouds/turned_box.h"

namespace blem_sim::sim {
namespace {

constexpr int MOST_CROSSINGS = 1000;    // of a ray: beyond, the point counts as outside
constexpr double STRAIGHT_OUT = 0.7;    // of the way down: a surface beside that is nearer is the way out
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

/** [m] From a point inside straight down to the surface; infinity if nothing is there. @param down unit, in the geometry's frame */
double wayDown(const contact::CollisionGeometry& geometry, const Vector3& p, const Vector3& down) {
  const geometry::RayHit hit = geometry::castRay({geometry.bvh(), geometry.mesh()}, {p, down});
  return hit.element < 0 ? std::numeric_limits<double>::infinity() : hit.t;
}

/** Whether the surface comes within a distance [m] of a point. */
bool isNear(const contact::CollisionGeometry& geometry, const Vector3& p, double distance) {
  const Vector3 room = Vector3::Constant(distance);
  bool near = false;
  geometry::visitLeaves(geometry.bvh(), Box(p - room, p + room), [&](std::uint32_t leaf) {
    const geometry::Bvh::Node& node = geometry.bvh().nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count && !near; ++i)
      near = geometry::closestPointTriangle(p, geometry::triangleOf(geometry.mesh(), geometry.bvh().order()[i])).distance < distance;
  });
  return near;
}

/** Vertices of the cloud inside the geometry, sorted. @param X_GC the cloud in the geometry's frame */
std::vector<int> verticesInside(const contact::CollisionGeometry& geometry, const contact::CollisionGeometry& cloud, const Pose& X_GC) {
  std::vector<int> inside;
  geometry::visitLeaves(cloud.bvh(), turned(geometry.bounds(), X_GC.inverse()), [&](std::uint32_t leaf) {
    const geometry::Bvh::Node& node = cloud.bvh().nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Vector3i& element = cloud.mesh().elements[cloud.bvh().order()[i]];
      for (const int vertex : {element[0], element[1], element[2]})
        if (geometry.bounds().contains(X_GC * cloud.mesh().vertices[vertex])) inside.push_back(vertex);
    }
  });
  if (inside.empty() || !isClosed(geometry)) return {};
  std::sort(inside.begin(), inside.end());
  inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
  const auto isOutside = [&](int vertex) { return !isInside(geometry, X_GC * cloud.mesh().vertices[vertex]); };
  inside.erase(std::remove_if(inside.begin(), inside.end(), isOutside), inside.end());
  return inside;
}

/** Corners of elements that come within a distance [m] of the geometry's box, sorted. @param X_GC the cloud in the geometry's frame */
std::vector<int> cornersAround(const contact::CollisionGeometry& geometry, const contact::CollisionGeometry& cloud, const Pose& X_GC,
                               double distance) {
  const Vector3 room = Vector3::Constant(distance);
  const Box around = turned(Box(geometry.bounds().min() - room, geometry.bounds().max() + room), X_GC.inverse());
  std::vector<int> corners;
  geometry::visitLeaves(cloud.bvh(), around, [&](std::uint32_t leaf) {
    const geometry::Bvh::Node& node = cloud.bvh().nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Vector3i& element = cloud.mesh().elements[cloud.bvh().order()[i]];
      Box box;
      for (int k = 0; k < 3; ++k) box.extend(cloud.mesh().vertices[element[k]]);
      if (box.intersects(around)) corners.insert(corners.end(), element.data(), element.data() + 3);
    }
  });
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

/**
 * Depth of what a body is buried in. Vertices near its rim lie as deep as others of one floor, though a side is nearer.
 * @param down unit or zero @param ways [m] of each point down to the surface; none if down is zero
 */
BuriedPoints partInside(const contact::CollisionGeometry& geometry, const std::vector<Vector3>& points, const Vector3& down,
                        std::vector<double>* ways) {
  BuriedPoints buried;
  if (down.isZero()) return buried;
  for (const Vector3& p : points) {
    ways->push_back(wayDown(geometry, p, down));
    const double way = ways->back();
    if (way <= MOST_BURIED && way > buried.way && !isNear(geometry, p, STRAIGHT_OUT * way)) buried.way = way;
  }
  return buried;
}

/** @param X_GC the cloud in the geometry's frame @param down unit or zero, there */
void addInside(const contact::CollisionGeometry& geometry, const contact::CollisionGeometry& cloud, const Pose& X_GC, const Vector3& down,
               InnerPoints* inner) {
  const std::vector<int> inside = verticesInside(geometry, cloud, X_GC);
  std::vector<Vector3> points;
  for (const int vertex : inside) points.push_back(X_GC * cloud.mesh().vertices[vertex]);
  std::vector<double> ways;
  BuriedPoints buried = partInside(geometry, points, down, &ways);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (buried.way > 0 && ways[i] <= buried.way) {
      buried.vertices.push_back(inside[i]);
      buried.ways.push_back(ways[i]);
    } else {
      inner->gone.push_back({inside[i], std::numeric_limits<double>::infinity()});
    }
  }
  if (buried.way > 0) inner->buried.push_back(std::move(buried));
}

}  // namespace

InnerPoints innerPoints(const SimulatedWorld& world, const std::vector<dynamics::BodyState>& bodies, int cloud, const Vector3& up) {
  InnerPoints inner;
  const contact::Collider& points = world.colliders[cloud];
  for (std::size_t i = 0; i < world.colliders.size(); ++i) {
    const contact::Collider& collider = world.colliders[i];
    if (!collider.enabled || collider.body == dynamics::WORLD_BODY || collider.geometry->isHalfSpace()) continue;
    const Pose X_GW = (bodies[collider.body].X_WB * collider.X_BC).inverse();
    const std::size_t before = inner.buried.size();
    addInside(*collider.geometry, *points.geometry, X_GW * points.X_BC, X_GW.linear() * -up, &inner);
    if (inner.buried.size() == before) continue;
    inner.buried.back().body_collider = static_cast<int>(i);
    inner.buried.back().around = cornersAround(*collider.geometry, *points.geometry, X_GW * points.X_BC, collider.radius + points.radius);
  }
  return inner;
}

}  // namespace blem_sim::sim
