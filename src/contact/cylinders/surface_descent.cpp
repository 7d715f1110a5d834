#include "cylinders/surface_descent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blem_sim/geometry/bvh_traversal.h"
#include "blem_sim/geometry/closest_points.h"
#include "features/tolerances.h"

namespace blem_sim::contact {
namespace {

constexpr int MOST_FEATURES = 8, MOST_TRIANGLES = 200;  // on a way
constexpr int MOST_HALVINGS = 60;
constexpr double SAME_PART = 1e-15;  // of an edge

}  // namespace

bool projectOnto(const geometry::Cylinder& cylinder, const Vector3& q, Vector3* x) {
  const double from_axis = std::hypot(q.x(), q.y()), z = std::clamp(q.z(), -cylinder.half_length, cylinder.half_length);
  if (from_axis <= cylinder.radius) return false;
  *x = {cylinder.radius / from_axis * q.x(), cylinder.radius / from_axis * q.y(), z};
  return true;
}

bool isAtRim(const geometry::Cylinder& cylinder, const Vector3& x) {
  constexpr double SAME = 1e-7;  // [m]
  return std::abs(x.z()) >= cylinder.half_length - SAME;
}

bool SurfaceDescent::approach(NearestPlace* place) const {
  Vector3& q = place->on_surface;
  if (place->feature.kind == FeatureKind::VERTEX)
    q = vertex(place->feature.index);
  else
    approachEdge(place->feature.index, &q);
  return projectOnto(cylinder_, q, &place->on_cylinder);
}

/** Sets q to the edge's point that is nearest to the solid cylinder; of an edge that is nearly parallel to the axis, whose contacts at both
 * rims stay, to one near q. */
void SurfaceDescent::approachEdge(int edge, Vector3* q) const {
  const auto ends = surface_.topology().ends(surface_.mesh(), edge);
  const Vector3 start = vertex(ends[0]), along = vertex(ends[1]) - start;
  const double across2 = along.head<2>().squaredNorm(), length2 = along.squaredNorm();
  const auto pointAt = [&](double part) -> Vector3 { return start + std::clamp(part, 0.0, 1.0) * along; };
  if (across2 > MIN_EDGE_SINE * MIN_EDGE_SINE * length2) {
    const Vector3 beside_axis = pointAt(-start.head<2>().dot(along.head<2>()) / across2);
    if (std::abs(beside_axis.z()) <= cylinder_.half_length) {
      *q = beside_axis;
      return;
    }
  }
  if (across2 < EDGE_CONE_SLACK * EDGE_CONE_SLACK * length2) return stayNear(start, along, q);
  const auto leadsAway = [&](double part) { return along.dot(beyond(pointAt(part))); };  // half the squared distance's slope: it grows
  double lower = 0, at_lower = leadsAway(0), upper = 1, at_upper = leadsAway(1);
  if (at_lower >= 0 || at_upper <= 0) {
    *q = pointAt(at_lower >= 0 ? 0 : 1);
    return;
  }
  double part = lower;
  for (int i = 0; i < MOST_HALVINGS && std::abs(upper - lower) > SAME_PART; ++i) {  // Illinois' rule of the false position
    part = i % 3 == 2 ? 0.5 * (lower + upper) : upper - at_upper * (upper - lower) / (at_upper - at_lower);
    const double at_part = leadsAway(part);
    if (at_part * at_upper < 0) {
      lower = upper;
      at_lower = at_upper;
    } else {
      at_lower *= 0.5;
    }
    upper = part;
    at_upper = at_part;
    if (at_part == 0) break;
  }
  *q = pointAt(part);
}

/** Sets q, from that at hand on, to a point of an edge that is nearly parallel to the axis. */
void SurfaceDescent::stayNear(const Vector3& start, const Vector3& along, Vector3* q) const {
  constexpr int TIMES = 4;
  for (int i = 0; i < TIMES; ++i) {
    Vector3 x;
    if (!projectOnto(cylinder_, *q, &x)) return;
    *q = start + std::clamp((x - start).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
  }
}

/** From the nearest point of the solid cylinder to q. */
Vector3 SurfaceDescent::beyond(const Vector3& q) const {
  const double from_axis = std::hypot(q.x(), q.y()), out = from_axis > cylinder_.radius ? 1 - cylinder_.radius / from_axis : 0;
  return {out * q.x(), out * q.y(), q.z() - std::clamp(q.z(), -cylinder_.half_length, cylinder_.half_length)};
}

bool SurfaceDescent::descend(NearestPlace* place) const {
  for (int i = 0; i < MOST_FEATURES; ++i) {
    const Vector3 way = place->on_cylinder - place->on_surface;
    if (way.norm() <= TOUCH) return false;
    const Vector3 towards = way.normalized();
    if (std::hypot(towards.x(), towards.y()) < rolls_ || !findNext(towards, place)) return true;
    if (place->feature.kind == FeatureKind::FACE) {
      const OverFace end = overFace(towards, place);
      if (end != OverFace::LEAVES) return end == OverFace::STAYS;
    }
    if (!approach(place)) return false;
  }
  return false;
}

bool SurfaceDescent::descendFrom(const Vector3& up, NearestPlace* place) const {
  place->triangle = triangleNear(*place);
  if (place->triangle < 0) return false;
  const OverFace end = overFace(up, place);
  return end == OverFace::LEAVES ? approach(place) && descend(place) : end == OverFace::STAYS;
}

/** Sets the feature that the way between the nearest points leads to. @return false if it leads nowhere */
bool SurfaceDescent::findNext(const Vector3& towards, NearestPlace* place) const {
  if (place->feature.kind == FeatureKind::VERTEX) return findEdgeAt(place->feature.index, towards, place);
  if (findFaceBeside(towards, place)) return true;
  for (const int end : surface_.topology().ends(surface_.mesh(), place->feature.index))
    if ((vertex(end) - place->on_surface).norm() <= CLOSED) return findEdgeAt(end, towards, place);
  return false;
}

bool SurfaceDescent::findEdgeAt(int at, const Vector3& towards, NearestPlace* place) const {
  double most = CONE_SLACK;
  bool found = false;
  const Vector3 p = vertex(at);
  for (const int edge : surface_.topology().edgesOf(at)) {
    const double leads = (vertex(surface_.topology().otherEnd(surface_.mesh(), edge, at)) - p).normalized().dot(towards);
    if (leads <= most) continue;
    most = leads;
    place->feature = {FeatureKind::EDGE, edge};
    found = true;
  }
  return found;
}

bool SurfaceDescent::findFaceBeside(const Vector3& towards, NearestPlace* place) const {
  double most = CONE_SLACK;
  bool found = false;
  const int edge = place->feature.index;
  for (const int face : surface_.topology().facesOf(edge)) {
    const double leads = into(edge, face).dot(towards);
    if (leads <= most) continue;
    most = leads;
    place->feature = {FeatureKind::FACE, surface_.topology().patchOf(face)};
    place->triangle = face;
    found = true;
  }
  return found;
}

/**
 * Sets the points to the rim's lowest one and its foot, over the face or over one that rises beside it by less than a side turns, or the
 * feature to the edge over which the foot leaves their planes.
 */
SurfaceDescent::OverFace SurfaceDescent::overFace(const Vector3& towards, NearestPlace* place) const {
  const double side_turn = 2 * M_PI / cylinder_.sides;
  Vector3 up = towards;
  for (int i = 0; i < MOST_TRIANGLES; ++i) {
    const Vector3 normal = X_KO_.linear() * geometry::MeshTopology::normal(surface_.mesh(), place->triangle);
    up = normal.dot(up) < 0 ? Vector3(-normal) : normal;
    if (std::hypot(up.x(), up.y()) < rolls_) return OverFace::NOT_ROLLING;
    const int edge = putLowest(up, place);
    if (edge == geometry::MeshTopology::NO_EDGE) return OverFace::STAYS;
    int face = -1;
    const double slope = steepestBeside(edge, up, &face);
    if (slope <= CONE_SLACK) {
      place->feature = {FeatureKind::EDGE, edge};
      return OverFace::LEAVES;
    }
    if (slope > side_turn) return OverFace::STAYS;
    place->feature = {FeatureKind::FACE, surface_.topology().patchOf(face)};
    place->triangle = face;
  }
  return OverFace::STAYS;
}

/** Sets the points to the rim's lowest one and its foot. @return edge over which the foot leaves the plane's faces, or NO_EDGE */
int SurfaceDescent::putLowest(const Vector3& up, NearestPlace* place) const {
  const double lean = std::hypot(up.x(), up.y());
  const double z = std::copysign(cylinder_.half_length, isAtRim(cylinder_, place->on_cylinder) ? place->on_cylinder.z() : -up.z());
  const Vector3 lowest(-cylinder_.radius / lean * up.x(), -cylinder_.radius / lean * up.y(), z);
  const Vector3 foot = lowest - up.dot(lowest - vertex(surface_.mesh().elements[place->triangle][0])) * up;
  const int edge = leftOver(place->on_surface, foot, &place->triangle);
  place->on_surface = foot;
  place->on_cylinder = lowest;
  return edge;
}

/** Triangle of the face's plane that is nearest to on_surface; -1 if none is near. */
int SurfaceDescent::triangleNear(const NearestPlace& place) const {
  const Vector3 p = X_KO_.inverse() * place.on_surface, room = Vector3::Constant(M_PI / cylinder_.sides * cylinder_.radius);
  double least = std::numeric_limits<double>::infinity();
  int nearest = -1;
  geometry::visitLeaves(surface_.bvh(), Box(p - room, p + room), [&](std::uint32_t leaf) {
    const geometry::Bvh::Node& node = surface_.bvh().nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const int element = static_cast<int>(surface_.bvh().order()[i]);
      if (!surface_.topology().isFace(element) || surface_.topology().patchOf(element) != place.feature.index) continue;
      const double distance = geometry::closestPointTriangle(p, geometry::triangleOf(surface_.mesh(), element)).distance;
      if (distance >= least) continue;
      least = distance;
      nearest = element;
    }
  });
  return nearest;
}

/** Edge over which the straight way between two points leaves a plane's faces; NO_EDGE if it does not. @param triangle of the way */
int SurfaceDescent::leftOver(const Vector3& from, const Vector3& to, int* triangle) const {
  int entered = geometry::MeshTopology::NO_EDGE;
  for (int i = 0; i < MOST_TRIANGLES; ++i) {
    double soonest = std::numeric_limits<double>::infinity();
    int left = geometry::MeshTopology::NO_EDGE;
    for (int k = 0; k < 3; ++k) {
      const int edge = surface_.topology().edgeOf(*triangle, k);
      const Vector3 inward = into(edge, *triangle), corner = vertex(surface_.mesh().elements[*triangle][k]);
      const double end = inward.dot(to - corner), start = std::max(0.0, inward.dot(from - corner));
      if (edge == entered || end >= -CLOSED || start / (start - end) >= soonest) continue;
      soonest = start / (start - end);
      left = edge;
    }
    if (left == geometry::MeshTopology::NO_EDGE || !surface_.topology().isFlatEdge(left)) return left;
    const geometry::EdgeFaces faces = surface_.topology().facesOf(left);
    *triangle = faces[0] == *triangle ? faces[1] : faces[0];
    entered = left;
  }
  return geometry::MeshTopology::NO_EDGE;
}

/** Sine by which the steepest face beside the edge rises from the plane below; 0 if none does. @param face set to it */
double SurfaceDescent::steepestBeside(int edge, const Vector3& up, int* face) const {
  double steepest = 0;
  for (const int beside : surface_.topology().facesOf(edge)) {
    const double slope = into(edge, beside).dot(up);
    if (slope <= steepest) continue;
    steepest = slope;
    *face = beside;
  }
  return steepest;
}

}  // namespace blem_sim::contact
