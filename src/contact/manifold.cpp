#include "blem_sim/contact/manifold.h"

#include <algorithm>
#include <array>
#include <limits>

#include "blem_sim/contact/collider.h"
#include "blem_sim/geometry/bvh_traversal.h"
#include "features/mesh_pair.h"

namespace blem_sim::contact {
namespace {

constexpr double ON_PLANE = 1e-6;  // [m] and of the coordinates: a triangle no farther from a place may hold it

/** Weights of a triangle's corners at the foot of a point on its plane; some negative outside. */
Vector3 weightsAt(const geometry::TriangleMesh& mesh, const Vector3i& corners, const Vector3& p) {
  const Vector3 a = mesh.vertices[corners[0]], u = mesh.vertices[corners[1]] - a, v = mesh.vertices[corners[2]] - a;
  const Vector3 normal = u.cross(v);
  const double scale = 1 / normal.squaredNorm(), of_u = (p - a).cross(v).dot(normal) * scale, of_v = u.cross(p - a).dot(normal) * scale;
  return {1 - of_u - of_v, of_u, of_v};
}

/** Place in the triangle of a plane that holds the foot of a point. @param first triangle of the plane */
MeshPlace placeInPlane(const CollisionGeometry& geometry, int first, const Vector3& p) {
  const geometry::TriangleMesh& mesh = geometry.mesh();
  if (!geometry.topology().isFace(first)) return {mesh.elements[first], Vector3::UnitX()};
  MeshPlace best{mesh.elements[first], weightsAt(mesh, mesh.elements[first], p)};
  if (best.weights.minCoeff() < 0) {
    const Vector3 normal = geometry::MeshTopology::normal(mesh, first);
    const Vector3 foot = p - normal * normal.dot(p - mesh.vertices[best.corners[0]]);
    const Vector3 around = Vector3::Constant(ON_PLANE * (1 + foot.norm()));
    geometry::visitLeaves(geometry.bvh(), Box(foot - around, foot + around), [&](std::uint32_t leaf) {
      const geometry::Bvh::Node& node = geometry.bvh().nodes()[leaf];
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const int element = static_cast<int>(geometry.bvh().order()[i]);
        if (!geometry.topology().isFace(element) || geometry.topology().patchOf(element) != first) continue;
        const Vector3 weights = weightsAt(mesh, mesh.elements[element], p);
        if (weights.minCoeff() > best.weights.minCoeff()) best = {mesh.elements[element], weights};
      }
    });
  }
  best.weights = best.weights.cwiseMax(0);
  best.weights /= best.weights.sum();
  return best;
}

/** [1/m] Curvature of the layer on which a contact lies. */
double curvature(const Collider& collider, std::uint64_t id, bool is_a, double depth) {
  const FeatureKind kind = featureOf(id, is_a).kind;
  if (kind == FeatureKind::FACE || kind == FeatureKind::HALF_SPACE) return 0;
  const bool is_round = collider.geometry->hasOnlyPoints() || rimRadius(collider, id, is_a) > 0;
  const double radius = is_round ? collider.radius - 0.5 * depth : 0;
  return radius > 0 ? 1 / radius : std::numeric_limits<double>::infinity();
}

}  // namespace

double rimRadius(const Collider& collider, std::uint64_t id, bool is_a) {
  if (collider.body < 0 || !collider.geometry->cylinder()) return 0;
  const Feature own = featureOf(id, is_a);
  const FeatureKind other = featureOf(id, !is_a).kind;
  const bool is_rim = own.kind == FeatureKind::VERTEX && own.index >= 2 * collider.geometry->cylinder()->sides;
  return is_rim && (other == FeatureKind::FACE || other == FeatureKind::HALF_SPACE) ? collider.geometry->cylinder()->radius : 0;
}

double rollingRadius(const Collider& a, const Collider& b, const Contact& contact) {
  const double sum = curvature(a, contact.id, true, contact.depth) + curvature(b, contact.id, false, contact.depth);
  return sum > 0 ? 1 / sum : 0;
}

MeshPlace placeOf(std::uint64_t id, bool of_a, const CollisionGeometry& geometry, const Vector3& p) {
  const Feature feature = featureOf(id, of_a);
  if (feature.kind == FeatureKind::VERTEX) return {Vector3i::Constant(feature.index), Vector3::UnitX()};
  if (feature.kind == FeatureKind::FACE) return placeInPlane(geometry, feature.index, p);
  const std::array<int, 2> ends = geometry.topology().ends(geometry.mesh(), feature.index);
  const Vector3 a = geometry.mesh().vertices[ends[0]], way = geometry.mesh().vertices[ends[1]] - a;
  const double along = std::min(1.0, std::max(0.0, way.dot(p - a) / way.squaredNorm()));
  return {{ends[0], ends[1], ends[1]}, {1 - along, along, 0}};
}

double ContactManifold::maxDepth() const {
  // Several maxima at once: one alone would wait for the last comparison.
  constexpr std::size_t CHAINS = 4;
  constexpr double NONE = -std::numeric_limits<double>::infinity();
  double deepest[CHAINS] = {NONE, NONE, NONE, NONE};
  std::size_t i = 0;
  for (; i + CHAINS <= contacts.size(); i += CHAINS) {
    for (std::size_t chain = 0; chain < CHAINS; ++chain) deepest[chain] = std::max(deepest[chain], contacts[i + chain].depth);
  }
  for (; i < contacts.size(); ++i) deepest[0] = std::max(deepest[0], contacts[i].depth);
  return *std::max_element(deepest, deepest + CHAINS);
}

}  // namespace blem_sim::contact
