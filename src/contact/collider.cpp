#include "blem_sim/contact/collider.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>

#include "blem_sim/geometry/input_error.h"
#include "kernels/kernels.h"

namespace blem_sim::contact {
namespace {

double combinedFriction(double a, double b, FrictionRule rule) {
  switch (rule) {
    case FrictionRule::MIN:
      return std::min(a, b);
    case FrictionRule::HARMONIC_MEAN:
      return a > 0 && b > 0 ? 2 / (1 / a + 1 / b) : 0;
    case FrictionRule::MEAN:
      return 0.5 * (a + b);
    case FrictionRule::PRODUCT:
      return a * b;
  }
  return 0;
}

/** Springs (or dampers) in series; infinite = rigid. */
double inSeries(double a, double b) { return a > 0 && b > 0 ? 1 / (1 / a + 1 / b) : 0; }

}  // namespace

SurfaceProperties combineSurfaces(const SurfaceProperties& a, const SurfaceProperties& b, FrictionRule rule) {
  SurfaceProperties pair;
  pair.friction = combinedFriction(a.friction, b.friction, rule);
  pair.restitution = std::max(a.restitution, b.restitution);
  std::tie(pair.impact_friction_factor, pair.impact_friction_speed) =
      std::min(std::tie(a.impact_friction_factor, a.impact_friction_speed), std::tie(b.impact_friction_factor, b.impact_friction_speed));
  pair.stiffness = inSeries(a.stiffness, b.stiffness);
  pair.damping = inSeries(a.damping, b.damping);
  return pair;
}

CollisionGeometry::CollisionGeometry(std::shared_ptr<const geometry::TriangleMesh> mesh,
                                     std::shared_ptr<const geometry::MeshTopology> topology, std::optional<geometry::Cylinder> cylinder)
    : mesh_(std::move(mesh)),
      topology_(std::move(topology)),
      cylinder_(cylinder ? std::make_shared<const geometry::Cylinder>(*cylinder) : nullptr) {
  if (!mesh_ || mesh_->elements.empty()) throw InputError("collision geometry: the mesh has no element; leave the collider out");
  kernels::kernels();  // bad settings are told here, not in a step
  if (!topology_) topology_ = std::make_shared<const geometry::MeshTopology>(*mesh_);
  bvh_ = geometry::Bvh(*mesh_, kernels::MAX_LEAF_ELEMENTS);
  static std::atomic<std::uint64_t> last_identity{0};
  identity_ = ++last_identity;
  only_triangles_ = std::all_of(mesh_->elements.begin(), mesh_->elements.end(),
                                [](const Vector3i& e) { return e[0] != e[1] && e[1] != e[2] && e[2] != e[0]; });
  only_points_ =
      std::all_of(mesh_->elements.begin(), mesh_->elements.end(), [](const Vector3i& e) { return e[0] == e[1] && e[1] == e[2]; });
  findOwners();
  bounds_ = mesh_->bounds();
}

// Children lie behind their parents.
void CollisionGeometry::findOwners() {
  const std::vector<geometry::Bvh::Node>& nodes = bvh_.nodes();
  const auto asks = [&topology = *topology_](std::uint32_t element) {
    return topology.ownedVertices(static_cast<int>(element)) != 0 || topology.ownedEdges(static_cast<int>(element)) != 0;
  };
  owners_.resize(nodes.size());
  for (std::size_t n = nodes.size(); n-- > 0;) {
    if (!nodes[n].isLeaf()) {
      owners_[n] = owners_[nodes[n].first] | owners_[nodes[n].first + 1];
      continue;
    }
    const std::uint32_t* const first = bvh_.order().data() + nodes[n].first;
    owners_[n] = std::any_of(first, first + nodes[n].count, asks);
  }
}

std::size_t CollisionGeometry::bytes() const {
  return isHalfSpace() ? 0 : mesh_->bytes() + topology_->bytes() + bvh_.bytes() + owners_.capacity();
}

std::shared_ptr<const CollisionGeometry> CollisionGeometry::halfSpace(const Vector3& normal, double offset) {
  const double norm = normal.norm();
  if (!(norm > 0) || !std::isfinite(norm) || !std::isfinite(offset)) {
    throw InputError("half-space: normal and offset must be finite, the normal not zero");
  }
  const std::shared_ptr<CollisionGeometry> geometry(new CollisionGeometry);
  geometry->normal_ = normal / norm;
  geometry->offset_ = offset;
  const Vector3 far = Vector3::Constant(std::numeric_limits<double>::infinity());
  geometry->bounds_ = Box(-far, far);
  return geometry;
}

}  // namespace blem_sim::contact
