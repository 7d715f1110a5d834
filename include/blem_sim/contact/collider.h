// Colliders: boundary-layer expanded meshes [Hauser 2013, Eq. 1] placed on bodies.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blem_sim/geometry/bvh.h"
#include "blem_sim/geometry/cylinder.h"
#include "blem_sim/geometry/mesh_topology.h"
#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::contact {

/** Surface of a body as contact response wants it. */
struct SurfaceProperties {
  double friction = 0.5;  ///< Coulomb coefficient
  double restitution = 0;
  double impact_friction_factor = 1;                           ///< 0 to 1: friction in impacts over friction
  double impact_friction_speed = 0;                            ///< [m/s] closing speed up to which that factor does not act
  double stiffness = std::numeric_limits<double>::infinity();  ///< [N/m] per contact; infinite = rigid
  double damping = std::numeric_limits<double>::infinity();    ///< [N s/m] per contact
};

enum class FrictionRule { MIN, HARMONIC_MEAN, MEAN, PRODUCT };

/** Surface of a pair: friction by the rule (harmonic mean: 2/(1/a+1/b)), the larger restitution, the smaller impact friction factor
 * with its speed (of equal factors the smaller speed), springs and dampers in series. */
SurfaceProperties combineSurfaces(const SurfaceProperties& a, const SurfaceProperties& b, FrictionRule rule);

/** Geometry that contact searches, shared by all its copies: a mesh with its topology and tree, or a half-space. Immutable. */
class CollisionGeometry {
 public:
  /** @param topology of the mesh, if it is at hand @param cylinder that the mesh stands for; contacts are those of the cylinder */
  explicit CollisionGeometry(std::shared_ptr<const geometry::TriangleMesh> mesh,
                             std::shared_ptr<const geometry::MeshTopology> topology = nullptr,
                             std::optional<geometry::Cylinder> cylinder = std::nullopt);
  /** The solid half-space normal . x <= offset; normal is made unit. */
  static std::shared_ptr<const CollisionGeometry> halfSpace(const Vector3& normal, double offset);

  bool isHalfSpace() const { return mesh_ == nullptr; }
  const geometry::TriangleMesh& mesh() const { return *mesh_; }
  bool hasOnlyTriangles() const { return only_triangles_; }               ///< at least one, and neither segments nor points
  bool hasOnlyPoints() const { return only_points_; }                     ///< at least one: a ball, or those of a cloud
  const geometry::Cylinder* cylinder() const { return cylinder_.get(); }  ///< null: none
  const geometry::MeshTopology& topology() const { return *topology_; }
  const geometry::Bvh& bvh() const { return bvh_; }
  /** Per node of the tree: whether an element below it owns a vertex or an edge. Two nodes that own nothing have no contact. */
  const std::vector<std::uint8_t>& owners() const { return owners_; }
  /** A number that no other geometry of this run has; 0 for a half-space. */
  std::uint64_t identity() const { return identity_; }
  const Box& bounds() const { return bounds_; }  ///< [m], geometry frame; unbounded below for a half-space
  const Vector3& planeNormal() const { return normal_; }
  double planeOffset() const { return offset_; }
  std::size_t bytes() const;  ///< memory of mesh, topology and tree

 private:
  CollisionGeometry() = default;
  void findOwners();

  std::shared_ptr<const geometry::TriangleMesh> mesh_;
  std::shared_ptr<const geometry::MeshTopology> topology_;
  std::shared_ptr<const geometry::Cylinder> cylinder_;
  geometry::Bvh bvh_;
  std::vector<std::uint8_t> owners_;
  std::uint64_t identity_ = 0;
  bool only_triangles_ = false, only_points_ = false;
  Box bounds_;
  Vector3 normal_ = Vector3::UnitZ();
  double offset_ = 0;
};

/** A BLEM on a body. */
struct Collider {
  std::string name;              ///< "model::link", for messages and reports
  int body = -1;                 ///< dynamics' body; -1 = part of the static world
  int model = -1;                ///< robot, object or environment it belongs to; contact budgets and self-collision go by it
  int link = -1;                 ///< link of its robot, else -1
  Pose X_BC = Pose::Identity();  ///< geometry frame in the body's frame (in the world's if static)
  std::shared_ptr<const CollisionGeometry> geometry;
  std::shared_ptr<const CollisionGeometry> outside;  ///< surface that the layer reaches, if that lies inside of it; else null
  double radius = 0;                                 ///< [m] r, boundary width
  SurfaceProperties surface;
  bool enabled = true;  ///< false: an unloaded slot, never collides; the next environment takes it

  /** The surface that cameras, lidars and pictures see. */
  const std::shared_ptr<const CollisionGeometry>& seen() const { return outside ? outside : geometry; }
};

}  // namespace blem_sim::contact
