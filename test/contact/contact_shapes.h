// Shapes and colliders that the tests of the narrow phase share.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "blem_sim/contact/narrow_phase.h"
#include "geometry/random_shapes.h"

namespace blem_sim::contact {

inline Collider makeCollider(geometry::TriangleMesh mesh, double radius = 0) {
  Collider collider;
  collider.geometry = std::make_shared<CollisionGeometry>(std::make_shared<geometry::TriangleMesh>(std::move(mesh)));
  collider.radius = radius;
  return collider;
}

inline Collider makeHalfSpace(const Vector3& normal, double offset, double radius = 0) {
  Collider collider;
  collider.geometry = CollisionGeometry::halfSpace(normal, offset);
  collider.radius = radius;
  return collider;
}

inline geometry::TriangleMesh octahedronMesh(double radius) {
  geometry::TriangleMesh mesh;
  for (int k = 0; k < 3; ++k) {
    mesh.vertices.push_back(radius * Vector3::Unit(k));
    mesh.vertices.push_back(-radius * Vector3::Unit(k));
  }
  for (int x : {0, 1}) {
    for (int y : {2, 3}) {
      for (int z : {4, 5}) mesh.elements.push_back({x, y, z});
    }
  }
  return mesh;
}

/** A soup of unconnected triangles, segments and points. */
inline geometry::TriangleMesh soupMesh(geometry::RandomShapes& random, int count, double size) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vector3 centre = random.point(size);
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(centre + random.point(0.5 * size));
    const int first = 3 * i;
    mesh.elements.push_back(i % 5 == 3   ? Vector3i(first, first + 1, first + 1)
                            : i % 5 == 4 ? Vector3i(first, first, first)
                                         : Vector3i(first, first + 1, first + 2));
  }
  return geometry::cleanMesh(mesh, nullptr);
}

/** A grid whose heights are noise: concave and convex edges everywhere. */
inline geometry::TriangleMesh hillMesh(geometry::RandomShapes& random, double size, int cells, double height) {
  geometry::TriangleMesh mesh = geometry::gridMesh(size, size, cells, cells);
  for (Vector3& v : mesh.vertices) v.z() = random.uniform(-height, height);
  return mesh;
}

/** Room for searches of a test. */
inline NarrowPhaseWorkspace* searchRoom() {
  static NarrowPhaseWorkspace workspace;
  return &workspace;
}

inline ContactManifold contactsOf(const Collider& a, const Pose& X_WA, const Collider& b, const Pose& X_WB, double margin = 0) {
  ContactManifold manifold;
  narrowPhase({a, X_WA}, {b, X_WB}, {margin}, searchRoom(), &manifold);
  return manifold;
}

/** Lowers A onto B until the layers overlap by `overlap` [m]. */
inline Pose lowered(const Collider& a, Pose X_BA, const Collider& b, double overlap) {
  for (int i = 0; i < 100; ++i) {
    const ContactManifold manifold = contactsOf(a, X_BA, b, Pose::Identity(), 1e-3);
    const double missing = manifold.contacts.empty() ? 0.004 : overlap - manifold.maxDepth();
    if (std::abs(missing) < 1e-8) break;
    X_BA.translation().z() -= 0.9 * missing;
  }
  return X_BA;
}

inline bool allFinite(const ContactManifold& manifold) {
  return std::all_of(manifold.contacts.begin(), manifold.contacts.end(), [](const Contact& c) {
    return c.point.allFinite() && c.normal_BA.allFinite() && std::isfinite(c.depth) && std::abs(c.normal_BA.norm() - 1) < 1e-12;
  });
}

/** One of the 24 rotations that map the axes onto each other. */
inline Matrix3 axisRotation(geometry::RandomShapes& random) {
  Matrix3 R = Matrix3::Zero();
  const int x = random.integer(0, 2), y = (x + random.integer(1, 2)) % 3;
  R.col(0) = Vector3::Unit(x) * (random.integer(0, 1) ? 1 : -1);
  R.col(1) = Vector3::Unit(y) * (random.integer(0, 1) ? 1 : -1);
  R.col(2) = R.col(0).cross(R.col(1));
  return R;
}

/** The largest distance from a contact of `of` to the nearest one of `in`, as points [m] + normals + depths [m]; -1 if one has none. */
inline double largestDifference(const std::vector<Contact>& of, const std::vector<Contact>& in) {
  double largest = 0;
  for (const Contact& c : of) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Contact& d : in) {
      nearest = std::min(nearest, (c.point - d.point).norm() + (c.normal_BA - d.normal_BA).norm() + std::abs(c.depth - d.depth));
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

}  // namespace blem_sim::contact
