// The contacts of one pair of colliders.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "blem_sim/geometry/types.h"

namespace blem_sim::contact {

/** One contact of a pair (A, B); NaN until filled. */
struct Contact {
  /** [m] world; middle of the overlap of the two layers, (xA + xB)/2 + n (rB - rA)/2 [Hauser 2013, 3.2]. */
  Vector3 point = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  /** Unit, world, from B towards A: (xA - xB)/|xA - xB|. A push along it separates A from B. */
  Vector3 normal_BA = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  /** [m] rA + rB - |xA - xB|; negative = a gap: a speculative contact, which exists before touch. */
  double depth = std::numeric_limits<double>::quiet_NaN();
  /** Feature of A and feature of B that made it; the same from step to step while both stay the closest. */
  std::uint64_t id = 0;
  /** Share of the surface's stiffness and damping: weighSprings in reduction.h. */
  double weight = 1;
  /** The bare meshes cross here: direction and depth are the fallback's, not to be trusted. */
  bool pierced = false;
};

/** Vertex of A's mesh, or of B's, that made a contact of this id; -1 if an edge or a face did. */
inline int vertexOf(std::uint64_t id, bool of_a) {
  const std::uint64_t feature = id >> (of_a ? 32 : 0) & 0xFFFFFFFF;
  return feature >> 30 == 0 ? static_cast<int>(feature) : -1;
}

class CollisionGeometry;
struct Collider;

/** Place on a mesh: a vertex, or a mean of an edge's or a triangle's. */
struct MeshPlace {
  Vector3i corners = Vector3i::Zero();  ///< vertices
  Vector3 weights = Vector3::UnitX();   ///< of the corners, none negative, 1 in all
};

/**
 * Place where a feature of A, or of B, made a contact of this id. @param geometry of that collider, a mesh
 * @param p [m] in its frame; only its foot on the feature counts
 */
MeshPlace placeOf(std::uint64_t id, bool of_a, const CollisionGeometry& geometry, const Vector3& p);

/** [m] Radius of a rim of a moving cylinder whose lowest point made a contact of this id on a plane; 0 if none did. */
double rimRadius(const Collider& collider, std::uint64_t id, bool is_a);

/**
 * [m] Radius on which a contact rolls over both colliders [Montana 1988]: the ball's if a ball meets something flat, of two balls half
 * their harmonic mean, the layer's around a rim that rolls (rimRadius). Edges and corners of meshes stand on one point of theirs, 0: their
 * layers are thin.
 */
double rollingRadius(const Collider& a, const Collider& b, const Contact& contact);

/** All contacts of one pair of colliders; a < b. */
struct ContactManifold {
  int a = -1, b = -1;    ///< indices of the colliders
  double layer = 0;      ///< [m] rA + rB
  bool pierced = false;  ///< the bare meshes cross somewhere
  std::vector<Contact> contacts;

  /** Depth [m] of the deepest contact, -infinity if there is none. */
  double maxDepth() const;
};

}  // namespace blem_sim::contact
