// Meshes and vectors for Bullet.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim {

inline btVector3 toBullet(const Vector3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/** A mesh for Bullet, which must outlive the shapes made of it. */
inline std::unique_ptr<btTriangleMesh> bulletMesh(const geometry::TriangleMesh& mesh) {
  auto out = std::make_unique<btTriangleMesh>();
  for (const Vector3i& e : mesh.elements)
    out->addTriangle(toBullet(mesh.vertices[e[0]]), toBullet(mesh.vertices[e[1]]), toBullet(mesh.vertices[e[2]]));
  return out;
}

}  // namespace blem_sim
