// Two meshes in one frame, and contacts named by their features.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "features/side.h"

namespace blem_sim::contact {

enum class FeatureKind : std::uint8_t { VERTEX = 0, EDGE = 1, FACE = 2, HALF_SPACE = 3 };

/** A simplex of one mesh. A face is named by its planar patch, so that it keeps its name while a foot wanders over a plane's triangles. */
struct Feature {
  FeatureKind kind;
  int index;
};

/** Bits 62-63 kind of a, 32-61 its index, 30-31 kind of b, 0-29 its index. */
inline std::uint64_t contactId(const Feature& a, const Feature& b) {
  constexpr std::uint64_t INDEX_MASK = (1u << 30) - 1;
  const auto pack = [](const Feature& f) {
    return static_cast<std::uint64_t>(f.kind) << 30 | (static_cast<std::uint64_t>(f.index) & INDEX_MASK);
  };
  return pack(a) << 32 | pack(b);
}

static_assert(static_cast<int>(FeatureKind::VERTEX) == 0, "vertexOf knows vertices by it");

/** The id's feature of A, or of B. */
inline Feature featureOf(std::uint64_t id, bool of_a) {
  const std::uint64_t packed = id >> (of_a ? 32 : 0) & 0xFFFFFFFF;
  return {static_cast<FeatureKind>(packed >> 30), static_cast<int>(packed & ((1u << 30) - 1))};
}

/** One mesh of a pair. */
struct MeshSide {
  explicit MeshSide(const CollisionGeometry& geometry)
      : mesh(geometry.mesh()),
        topology(geometry.topology()),
        bvh(geometry.bvh()),
        owners(geometry.owners()),
        bounds(geometry.bounds()),
        identity(geometry.identity()) {}
  const geometry::TriangleMesh& mesh;
  const geometry::MeshTopology& topology;
  const geometry::Bvh& bvh;
  const std::vector<std::uint8_t>& owners;
  const Box& bounds;
  std::uint64_t identity;  ///< of the geometry, its own for as long as the program runs
};

/** Names that the two sides have outside of the search: one is A, the other B. And the widths of their layers. */
struct ContactRoles {
  Side a = Side::MOVING;
  PerSide<double> radius{0, 0};  ///< [m]

  double layer() const { return radius.moving + radius.fixed; }    ///< [m] rA + rB
  double shift() const { return 0.5 * (radius[!a] - radius[a]); }  ///< [m] (rB - rA) / 2
  /** @param normal from the fixed side to the moving one */
  Vector3 normalBA(const Vector3& normal) const { return a == Side::MOVING ? normal : Vector3(-normal); }
};

/** The moving mesh M, the one with fewer elements, is seen from the frame F of the other, fixed one: near the geometry wherever the pair is
 * in the world. */
struct MeshPair {
  MeshSide moving, fixed;
  Pose X_FM;
  double layer;  ///< [m] rA + rB
  double range;  ///< [m] contacts within this distance of the bare meshes: layer + margin
  ContactRoles roles;
  Pose X_WF = Pose::Identity();

  const MeshSide& side(Side side) const { return side == Side::MOVING ? moving : fixed; }
  /** Direction and point of either mesh in frame F. */
  Vector3 turned(const Vector3& direction, Side of) const { return of == Side::MOVING ? Vector3(X_FM.linear() * direction) : direction; }
  Vector3 placed(const Vector3& p, Side of) const { return of == Side::MOVING ? Vector3(X_FM * p) : p; }
};

/** A contact in frame F; its normal points from the fixed mesh to the moving one. */
struct FeatureContact {
  Feature moving, fixed;
  Vector3 point_M, point_F;  ///< [m] witness points on the moving and on the fixed mesh
  Vector3 normal;            ///< unit, fixed -> moving
  double gap;                ///< [m] distance of the witness points; negative where pierced
  bool pierced = false;
};

/** A feature and its witness point [m], frame F. */
struct Witness {
  Feature feature;
  Vector3 point;
};

/** The contact of a feature of a side with one of the other. @param normal from the fixed mesh to the moving one */
inline FeatureContact contactBetween(Side side, const Witness& own, const Witness& other, const Vector3& normal, double gap) {
  if (side == Side::MOVING) return {own.feature, other.feature, own.point, other.point, normal, gap};
  return {other.feature, own.feature, other.point, own.point, normal, gap};
}

}  // namespace blem_sim::contact
