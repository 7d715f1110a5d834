// Places of bare meshes by the poses of bodies alone: nothing here asks the simulator's contacts or bits.
#pragma once

#include <optional>
#include <vector>

#include "blem_sim/geometry/bvh_traversal.h"
#include "blem_sim/geometry/closest_points.h"
#include "blem_sim/sim/simulator.h"

namespace blem_sim {

/** Index of the first collider of a model. */
inline int colliderOf(const sim::Simulator& simulator, const std::string& model) {
  const int index = simulator.modelIndex(model);
  for (std::size_t i = 0; i < simulator.colliders().size(); ++i)
    if (simulator.colliders()[i].model == index) return static_cast<int>(i);
  return -1;
}

inline Pose poseOf(const sim::Simulator& simulator, int collider) {
  const contact::Collider& c = simulator.colliders()[collider];
  return c.body == dynamics::WORLD_BODY ? c.X_BC : simulator.report().bodies[c.body].X_WB * c.X_BC;
}

inline Vector3 centreOf(const sim::Simulator& simulator, int collider) {
  const contact::Collider& c = simulator.colliders()[collider];
  return simulator.report().bodies[c.body].X_WB * simulator.world().bodySpec(c.body).inertial.com;
}

/** Whether the segment crosses a triangle of the mesh, in the mesh's frame. */
inline bool crossesMesh(const Vector3& p, const Vector3& q, const contact::CollisionGeometry& geometry) {
  bool crosses = false;
  const Box box(p.cwiseMin(q), p.cwiseMax(q));
  if (!geometry.bounds().intersects(box)) return false;
  geometry::visitLeaves(geometry.bvh(), box, [&](std::uint32_t leaf) {
    const geometry::Bvh::Node& node = geometry.bvh().nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count && !crosses; ++i) {
      const Vector3i& e = geometry.mesh().elements[geometry.bvh().order()[i]];
      const std::vector<Vector3>& v = geometry.mesh().vertices;
      crosses = geometry::segmentCrossesTriangle(p, q, {v[e[0]], v[e[1]], v[e[2]]});
    }
  });
  return crosses;
}

/** Whether an edge of one mesh crosses a triangle of the other, either way round. */
inline bool meshesCross(const sim::Simulator& simulator, int a, int b) {
  for (const auto& [edges, faces] : {std::pair(a, b), std::pair(b, a)}) {
    const contact::CollisionGeometry &of_edges = *simulator.colliders()[edges].geometry, &of_faces = *simulator.colliders()[faces].geometry;
    const Pose X_FE = poseOf(simulator, faces).inverse() * poseOf(simulator, edges);
    std::vector<Vector3> placed;
    for (const Vector3& v : of_edges.mesh().vertices) placed.push_back(X_FE * v);
    for (const Vector3i& e : of_edges.mesh().elements)
      for (int k = 0; k < 3; ++k)
        if (crossesMesh(placed[e[k]], placed[e[(k + 1) % 3]], of_faces)) return true;
  }
  return false;
}

/** Tells whether a body's centre of mass went through another mesh, straight from one look to the next. */
class CentrePath {
 public:
  CentrePath(int thrown, int hit) : thrown_(thrown), hit_(hit) {}

  bool goesThrough(const sim::Simulator& simulator) {
    const Vector3 centre = poseOf(simulator, hit_).inverse() * centreOf(simulator, thrown_);
    const bool through = last_ && crossesMesh(*last_, centre, *simulator.colliders()[hit_].geometry);
    last_ = centre;
    return through;
  }
  int thrown() const { return thrown_; }

 private:
  int thrown_, hit_;
  std::optional<Vector3> last_;
};

/** A wall that nothing may get behind: a sheet's plane, a floor's upper face, or all faces of a convex room, in the wall's frame. */
struct Wall {
  int collider;
  std::vector<std::pair<Vector3, double>> planes;  ///< outward normal, offset [m]

  static Wall below(const sim::Simulator& simulator, const std::string& model, double height) {
    return {colliderOf(simulator, model), {{-Vector3::UnitZ(), -height}}};
  }
  static Wall around(const sim::Simulator& simulator, const std::string& model) {
    Wall wall{colliderOf(simulator, model), {}};
    const geometry::TriangleMesh& mesh = simulator.colliders()[wall.collider].geometry->mesh();
    const Vector3 middle = mesh.bounds().center();
    for (const Vector3i& e : mesh.elements) {
      const Vector3& p = mesh.vertices[e[0]];
      Vector3 normal = (mesh.vertices[e[1]] - p).cross(mesh.vertices[e[2]] - p).normalized();
      if (normal.dot(p - middle) < 0) normal = -normal;
      wall.planes.emplace_back(normal, normal.dot(p));
    }
    return wall;
  }
};

/** Part of a body that is behind a wall. */
enum class Behind { NOTHING, SOME, ALL };

/** Whether p is beside a sheet, not behind it: a body may have left it over its edge. */
inline bool isBeside(const Wall& wall, const Box& bounds, const Vector3& p) {
  return wall.planes.size() == 1 &&
         (p.x() < bounds.min().x() || p.x() > bounds.max().x() || p.y() < bounds.min().y() || p.y() > bounds.max().y());
}

inline Behind behind(const sim::Simulator& simulator, const Wall& wall, int collider) {
  const Box& bounds = simulator.colliders()[wall.collider].geometry->bounds();
  const Pose X_WC = poseOf(simulator, wall.collider).inverse() * poseOf(simulator, collider);
  int count = 0, all = 0;
  for (const Vector3& v : simulator.colliders()[collider].geometry->mesh().vertices) {
    const Vector3 p = X_WC * v;
    ++all;
    if (isBeside(wall, bounds, p)) continue;
    for (const auto& [normal, offset] : wall.planes) {
      if (!(normal.dot(p) > offset + 1e-9)) continue;
      ++count;
      break;
    }
  }
  return count == 0 ? Behind::NOTHING : count == all ? Behind::ALL : Behind::SOME;
}

}  // namespace blem_sim
