#include "blem_sim/contact/surface_cover.h"

#include <algorithm>
#include <cmath>

#include "blem_sim/geometry/bvh_traversal.h"
#include "blem_sim/geometry/closest_points.h"
#include "evaluation/world_contact.h"
#include "features/tolerances.h"

namespace blem_sim::contact {
namespace {

// Rounding of files and of poses leaves no more than this between planes that are meant to be one, and between directions in them.
constexpr double FLUSH = 1e-6;       // [m]
constexpr double SAME_PLANE = 1e-5;  // sine
constexpr double SAME_ANGLE = 1e-3;  // [rad]
constexpr double TURN = 2 * M_PI;

/** [m] Place of the contact on the surface, world. A contact that fades is less deep than its points tell; its place is on its feature. */
Vector3 placeOn(const Collider& own, const Pose& X_WO, const Contact& contact, bool own_is_a) {
  const Vector3 place = witnessOf(contact, own.radius, own_is_a);
  const Feature feature = featureOf(contact.id, own_is_a);
  if (feature.kind != FeatureKind::VERTEX && feature.kind != FeatureKind::EDGE) return place;
  const geometry::TriangleMesh& mesh = own.geometry->mesh();
  if (feature.kind == FeatureKind::VERTEX) return X_WO * mesh.vertices[feature.index];
  const std::array<int, 2> ends = own.geometry->topology().ends(mesh, feature.index);
  const Vector3 &p = mesh.vertices[ends[0]], &q = mesh.vertices[ends[1]];
  return X_WO * geometry::closestPointTriangle(X_WO.inverse() * place, {p, q, q}).point_b;
}

/** Unit normal: the longest product of two neighbouring directions. */
Vector3 normalOf(const Vector3* ways, int count) {
  Vector3 normal = Vector3::Zero();
  for (int k = 0; k < count; ++k) {
    const Vector3 product = ways[k].cross(ways[(k + 1) % count]);
    if (product.squaredNorm() > normal.squaredNorm()) normal = product;
  }
  return normal.normalized();
}

}  // namespace

// An edge that is flat lies in a plane, a vertex there or in a straight border.
void SurfaceCover::begin(const Contact& contact, bool own_is_a, const Collider& own, const Pose& X_WO) {
  own_ = &own;
  X_WO_ = X_WO;
  place_ = placeOn(own, X_WO, contact, own_is_a);
  away_ = own_is_a ? Vector3(-contact.normal_BA) : contact.normal_BA;
  is_of_vertex_ = featureOf(contact.id, !own_is_a).kind == FeatureKind::VERTEX;
  flat_ = !is_of_vertex_ && featureOf(contact.id, own_is_a).kind == FeatureKind::VERTEX ? M_PI + SAME_ANGLE : SAME_ANGLE;
  is_met_ = leads_along_ = false;
  faces_.clear();
}

void SurfaceCover::add(const Collider& other, const Pose& X_WO, bool comes_first) {
  if (leads_along_) return;
  if (!other.geometry->isHalfSpace()) return addFaces(other, X_WO, comes_first);
  const Vector3 normal = X_WO.linear() * other.geometry->planeNormal();
  if (std::abs(normal.dot(place_ - X_WO.translation()) - other.geometry->planeOffset()) > FLUSH) return;
  const Vector3 across = normal.unitOrthogonal(), along = normal.cross(across);
  is_met_ = true;
  leads_along_ = (normal - away_).norm() > CONE_SLACK;
  faces_.push_back({{across, -0.5 * across + 0.75 * along, -0.5 * across - 0.75 * along}, 3, comes_first});
}

void SurfaceCover::addFaces(const Collider& surface, const Pose& X_WS, bool comes_first) {
  const CollisionGeometry& geometry = *surface.geometry;
  const Vector3 p = X_WS.inverse() * place_, room = Vector3::Constant(FLUSH);
  const Box near(p - room, p + room);
  if (!geometry.bounds().intersects(near)) return;
  geometry::visitLeaves(geometry.bvh(), near, [&](std::uint32_t leaf) {
    const geometry::Bvh::Node& node = geometry.bvh().nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const geometry::Triangle triangle = geometry::triangleOf(geometry.mesh(), geometry.bvh().order()[i]);
      const geometry::ClosestPoints closest = geometry::closestPointTriangle(p, triangle);
      if (closest.distance > FLUSH) continue;
      Face face{{}, 0, comes_first};
      for (const Vector3& corner : triangle)
        if ((corner - closest.point_b).norm() > FLUSH) face.ways[face.count++] = X_WS.linear() * (corner - closest.point_b).normalized();
      faces_.push_back(face);
      if (&surface == own_) continue;
      is_met_ = true;
      for (int k = 0; k < face.count; ++k) leads_along_ = leads_along_ || face.ways[k].dot(away_) > CONE_SLACK;
    }
  });
}

/** The plane of the surface's own faces that looks the contact's way. @return false if none does */
bool SurfaceCover::findPlane(std::size_t first_own) {
  double best = 1 - 0.5 * EDGE_CONE_SLACK * EDGE_CONE_SLACK;
  bool found = false;
  for (std::size_t i = first_own; i < faces_.size(); ++i) {
    const Vector3 normal = normalOf(faces_[i].ways, faces_[i].count);
    const double looks = std::abs(normal.dot(away_));
    if (looks < best) continue;
    best = looks;
    normal_ = normal;
    found = true;
  }
  if (!found) return false;
  across_[0] = normal_.unitOrthogonal();
  across_[1] = normal_.cross(across_[0]);
  return true;
}

void SurfaceCover::addSector(const Face& face) {
  double angles[3];
  for (int k = 0; k < face.count; ++k) {
    if (std::abs(face.ways[k].dot(normal_)) > SAME_PLANE) return;
    angles[k] = std::atan2(face.ways[k].dot(across_[1]), face.ways[k].dot(across_[0]));
  }
  if (face.count < 2) return;
  if (angles[0] > angles[1]) std::swap(angles[0], angles[1]);
  if (face.count == 3 && angles[1] > angles[2]) std::swap(angles[1], angles[2]);
  if (angles[0] > angles[1]) std::swap(angles[0], angles[1]);
  int before = face.count - 1;  // the widest gap follows it
  double gap = angles[0] + TURN - angles[before];
  for (int k = 0; k + 1 < face.count; ++k) {
    if (angles[k + 1] - angles[k] <= gap) continue;
    gap = angles[k + 1] - angles[k];
    before = k;
  }
  sectors_.push_back({angles[(before + 1) % face.count], gap < M_PI - SAME_ANGLE ? TURN : TURN - gap});
}

/** Widest gap [rad] between directions in the plane that lead into faces. */
double SurfaceCover::widestGap() {
  if (sectors_.empty()) return TURN;
  std::sort(sectors_.begin(), sectors_.end(), [](const Sector& a, const Sector& b) { return a.first < b.first; });
  double gap = 0, reached = sectors_[0].first + sectors_[0].width;
  for (const Sector& sector : sectors_) {
    gap = std::max(gap, sector.first - reached);
    reached = std::max(reached, sector.first + sector.width);
  }
  return std::max(gap, sectors_[0].first + TURN - reached);
}

bool SurfaceCover::isCovered() {
  if (!is_met_ || leads_along_) return leads_along_;
  const std::size_t first_own = faces_.size();
  addFaces(*own_, X_WO_, false);
  if (!findPlane(first_own)) return false;
  sectors_.clear();
  for (const Face& face : faces_)
    if (!is_of_vertex_ || face.comes_first) addSector(face);
  return widestGap() <= flat_;
}

}  // namespace blem_sim::contact
