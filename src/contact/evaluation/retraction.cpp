#include "evaluation/retraction.h"

#include <algorithm>

#include "features/edge_pair.h"
#include "features/feature_cones.h"

namespace blem_sim::contact {
namespace {

/** Least cosine by which a contact of meshes that cross must push the bodies apart: with sides known from before, or guessed. */
constexpr double MIN_OUTWARD = 1e-3, MIN_OUTWARD_GUESSED = 0.2;
/** Retractions farther (cosine) from their mean direction than this are turned into it: one motion must be able to satisfy all of them. */
constexpr double MIN_AGREEMENT = 0.3;
/** A mean of unit vectors shorter than this says nothing. */
constexpr double MIN_MEAN = 0.1;

/** Sides of each other that the bodies were on before they crossed. Everything in frame F. */
class Sides {
 public:
  Sides(const MeshPair& pair, const Pose* X_FM_apart) : pair_(pair), known_(X_FM_apart != nullptr) {
    if (known_) back_ = *X_FM_apart * pair.X_FM.inverse();
  }

  /** Direction from the fixed body's side to the moving one's, where these two points are now; not unit, may be zero. */
  Vector3 between(const Vector3& point_M, const Vector3& point_F) const {
    return known_ ? Vector3(back_ * point_M - point_F) : bodySide(pair_, point_F);
  }

  /** Whether a contact pushes the moving body back to its side. */
  bool isOutward(const FeatureContact& contact) const {
    const Vector3 side = between(contact.point_M, contact.point_F);
    return contact.normal.dot(side) >= (known_ ? MIN_OUTWARD : MIN_OUTWARD_GUESSED) * side.norm();
  }

  /** The side along a face's normal, at a point where an edge passes through it. */
  double through(const Vector3& point, const Vector3& normal, Side face_side) const {
    const Vector3 then = known_ && face_side == Side::MOVING ? Vector3(back_.linear() * normal) : normal;
    return between(point, point).dot(then);
  }

 private:
  const MeshPair& pair_;
  const bool known_;
  Pose back_ = Pose::Identity();  // takes the moving body to where it was
};

class Retraction {
 public:
  Retraction(const MeshPair& pair, const Sides& sides)
      : pair_(pair), sides_(sides), longest_(0.5 * std::min(pair.moving.bounds.diagonal().norm(), pair.fixed.bounds.diagonal().norm())) {}

  FeatureContact shortest(const Crossing& crossing) const {
    const MeshSide &edge_side = pair_.side(crossing.edge_side), &face_side = pair_.side(!crossing.edge_side);
    const bool edge_moves = crossing.edge_side == Side::MOVING;
    FeatureContact best = byEnd(crossing, edge_side, face_side);
    forEachBorderNear(face_side, crossing.face, [&](int border) {
      FeatureContact over_border;
      const int m = edge_moves ? crossing.edge : border, f = edge_moves ? border : crossing.edge;
      if (overEdges(m, f, &over_border) && over_border.gap > best.gap) best = over_border;
    });
    return best;
  }

 private:
  /** Calls visit(edge) for the borders of the face's plane at its corners: a border of the plane need not be one of this face. */
  template <typename Visit>
  static void forEachBorderNear(const MeshSide& side, int face, Visit&& visit) {
    const geometry::MeshTopology& topology = side.topology;
    const auto isBorder = [&topology, face](int edge) {
      if (topology.isFlatEdge(edge)) return false;
      const geometry::EdgeFaces faces = topology.facesOf(edge);
      return std::any_of(faces.begin(), faces.end(), [&](int other) { return topology.patchOf(other) == topology.patchOf(face); });
    };
    for (int k = 0; k < 3; ++k) {
      const int vertex = side.mesh.elements[face][k];
      for (const int edge : topology.edgesOf(vertex)) {
        if (isBorder(edge)) visit(edge);
      }
    }
  }

  Vector3 position(const MeshSide& side, int vertex) const {
    const Vector3& p = side.mesh.vertices[vertex];
    return &side == &pair_.moving ? Vector3(pair_.X_FM * p) : p;
  }

  FeatureContact byEnd(const Crossing& crossing, const MeshSide& edge_side, const MeshSide& face_side) const {
    const bool edge_moves = crossing.edge_side == Side::MOVING;
    const std::array<int, 2> ends = edge_side.topology.ends(edge_side.mesh, crossing.edge);
    const Vector3 p0 = position(edge_side, ends[0]), p1 = position(edge_side, ends[1]);
    Vector3 normal = geometry::MeshTopology::normal(face_side.mesh, crossing.face);
    if (&face_side == &pair_.moving) normal = pair_.X_FM.linear() * normal;
    const Vector3 corner = position(face_side, face_side.mesh.elements[crossing.face][0]);
    const double h0 = normal.dot(p0 - corner), h1 = normal.dot(p1 - corner);
    const Vector3 through = p0 + h0 / (h0 - h1) * (p1 - p0);
    double side = sides_.through(through, normal, !crossing.edge_side);
    if (side == 0) side = (std::abs(h0) < std::abs(h1) ? -h0 : -h1) * (edge_moves ? 1 : -1);
    if (side < 0) normal = -normal;
    // The end behind the face if the edge moves, in front of it if the face moves.
    const bool first = (normal.dot(p0 - through) < 0) == edge_moves;
    const Vector3 out = (first ? p0 : p1) - through;
    const Vector3 end = through + out * std::min(1.0, longest_ / out.norm());
    const Vector3 foot = end - normal * normal.dot(end - through);
    const Feature vertex{FeatureKind::VERTEX, ends[first ? 0 : 1]}, patch{FeatureKind::FACE, face_side.topology.patchOf(crossing.face)};
    const double gap = -std::abs(normal.dot(end - through));
    if (edge_moves) return {vertex, patch, end, foot, normal, gap, true};
    return {patch, vertex, foot, end, normal, gap, true};
  }

  bool overEdges(int m, int f, FeatureContact* out) const {
    const std::array<int, 2> ends_m = pair_.moving.topology.ends(pair_.moving.mesh, m),
                             ends_f = pair_.fixed.topology.ends(pair_.fixed.mesh, f);
    EdgePair feet;
    if (!findEdgePair({position(pair_.moving, ends_m[0]), position(pair_.moving, ends_m[1])},
                      {position(pair_.fixed, ends_f[0]), position(pair_.fixed, ends_f[1])}, longest_, &feet)) {
      return false;
    }
    // Crossed: the moving edge lies on the far side of the fixed one.
    const Vector3 normal = feet.offset < 0 ? feet.axis : Vector3(-feet.axis);
    if (feet.offset == 0 || sides_.between(feet.point_p, feet.point_q).dot(normal) <= 0) return false;
    if (!edgeConeAllows(pair_.fixed, f, normal, EDGE_CONE_SLACK) ||
        !edgeConeAllows(pair_.moving, m, -(pair_.X_FM.linear().transpose() * normal), EDGE_CONE_SLACK)) {
      return false;
    }
    *out = {{FeatureKind::EDGE, m}, {FeatureKind::EDGE, f}, feet.point_p, feet.point_q, normal, -std::abs(feet.offset), true};
    return true;
  }

  const MeshPair& pair_;
  const Sides& sides_;
  const double longest_;  // [m]
};

void turnIntoMean(const Sides& sides, std::vector<FeatureContact>::iterator begin, std::vector<FeatureContact>::iterator end) {
  Vector3 mean = Vector3::Zero(), side = Vector3::Zero();
  for (auto c = begin; c != end; ++c) {
    mean += c->normal;
    side += sides.between(c->point_M, c->point_F);
  }
  if (mean.norm() < MIN_MEAN * static_cast<double>(end - begin)) mean = side;
  if (!(mean.norm() > 0)) return;
  mean.normalize();
  for (auto c = begin; c != end; ++c)
    if (c->normal.dot(mean) < MIN_AGREEMENT) c->normal = mean;
}

}  // namespace

void addRetractions(const MeshPair& pair, const Pose* X_FM_apart, const std::vector<Crossing>& crossings,
                    std::vector<FeatureContact>* contacts) {
  const Sides sides(pair, X_FM_apart);
  const auto points_back = [&sides](const FeatureContact& contact) { return !sides.isOutward(contact); };
  contacts->erase(std::remove_if(contacts->begin(), contacts->end(), points_back), contacts->end());
  const Retraction retraction(pair, sides);
  const auto sound = static_cast<std::ptrdiff_t>(contacts->size());
  for (const Crossing& crossing : crossings) contacts->push_back(retraction.shortest(crossing));
  turnIntoMean(sides, contacts->begin() + sound, contacts->end());
}

}  // namespace blem_sim::contact
