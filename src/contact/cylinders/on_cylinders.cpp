#include "cylinders/on_cylinders.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blem_sim/contact/contact_order.h"
#include "cylinders/surface_descent.h"
#include "evaluation/world_contact.h"
#include "features/mesh_pair.h"
#include "features/tolerances.h"

namespace blem_sim::contact {
namespace {

// Sines of the lean from which on a rim has a lowest point; beyond which it rolls on it, and its other vertices fade; and are gone.
constexpr double LEANS = 1e-3, ROLLS = 0.05, ROLLS_ALONE = 0.1;
constexpr double SLAPS = 0.5;     // up to which an end may lie down within a step
constexpr double ON_MESH = 1e-7;  // [m] from the mesh; points farther away are those of contacts that fade

/** A cylinder in the world, and the surface that it meets. */
class RoundSide {
 public:
  /** @param contacts of the pair */
  RoundSide(const PlacedCollider& own, const PlacedCollider& other, bool is_a, const std::vector<Contact>& contacts)
      : own_(own),
        other_(other),
        contacts_(contacts),
        cylinder_(*own.collider.geometry->cylinder()),
        is_a_(is_a),
        is_named_by_place_(own.collider.body >= 0),
        X_WK_(own.X_WC * cylinder_.X_GK),
        X_KO_(X_WK_.inverse() * other.X_WC) {}

  /** Moves a contact of the mesh onto the cylinder. */
  void move(Contact* contact) const;

 private:
  Feature ownFeature(const Contact& contact) const { return featureOf(contact.id, is_a_); }
  Feature otherFeature(const Contact& contact) const { return featureOf(contact.id, !is_a_); }
  /** A rim as a whole; the middle of the flat end, which has no contacts, lends its name. */
  Feature rim(bool is_upper) const { return {FeatureKind::VERTEX, 2 * cylinder_.sides + is_upper}; }
  void rename(const Feature& own, const Feature& other, Contact* contact) const;
  Vector3 rimVertex(int index) const { return cylinder_.X_GK.inverse() * own_.collider.geometry->mesh().vertices[index]; }
  /** Unit, in the cylinder's frame: towards the other surface. */
  Vector3 towardsOther(const Contact& contact) const { return X_WK_.linear().transpose() * (is_a_ ? -1 : 1) * contact.normal_BA; }
  void overPlane(int vertex, Contact* contact) const;
  NearestPlace placeOf(int vertex, const Contact& contact) const;
  bool toWhatItMeets(int vertex, const Vector3& towards, Contact* contact) const;
  bool standsIn(int vertex, int nearest, const Vector3& towards, Contact* contact) const;
  void atPoint(Contact* contact) const;
  void atCylinder(int own_rim, Contact* contact) const;
  bool set(const NearestPlace& place, Contact* contact) const;
  bool isOnMesh(const Vector3& p) const;
  SurfaceDescent descent() const { return {cylinder_, *other_.collider.geometry, X_KO_, ROLLS}; }

  const PlacedCollider &own_, &other_;
  const std::vector<Contact>& contacts_;
  const geometry::Cylinder& cylinder_;
  const bool is_a_, is_named_by_place_;
  const Pose X_WK_, X_KO_;
};

bool isRim(const geometry::Cylinder& cylinder, const Feature& feature) {
  return feature.kind == FeatureKind::VERTEX && feature.index < 2 * cylinder.sides;
}

/** Whether a feature of a cylinder's mesh, which contacts have, belongs to mantle or rim: two of the four triangles of a side do. */
bool isRound(const Feature& feature) { return feature.kind != FeatureKind::FACE || feature.index % 4 < 2; }

/** Rim on which a feature of a cylinder's mesh lies: 0 the lower one, 1 the upper one, -1 none. */
int rimOf(const CollisionGeometry& geometry, const Feature& feature) {
  if (feature.kind == FeatureKind::VERTEX) return feature.index % 2;
  if (feature.kind != FeatureKind::EDGE) return -1;
  const auto ends = geometry.topology().ends(geometry.mesh(), feature.index);
  return ends[0] % 2 == ends[1] % 2 ? ends[0] % 2 : -1;
}

void RoundSide::rename(const Feature& own, const Feature& other, Contact* contact) const {
  const Feature named = is_named_by_place_ ? own : ownFeature(*contact);
  contact->id = is_a_ ? contactId(named, other) : contactId(other, named);
}

void RoundSide::move(Contact* contact) const {
  const Feature own = ownFeature(*contact), other = otherFeature(*contact);
  if (contact->pierced) return;
  if (other_.collider.geometry->cylinder() && isRound(own) && isRound(other)) {
    const int own_rim = rimOf(*own_.collider.geometry, own), other_rim = rimOf(*other_.collider.geometry, other);
    const bool asks = (own_rim < 0) == (other_rim < 0) ? is_a_ : own_rim >= 0;  // once for both: the side with a rim, else A
    if (asks) atCylinder(own_rim, contact);
    rename(own_rim < 0 ? Feature{FeatureKind::FACE, 0} : rim(own_rim == 1), other, contact);
  } else if (other.kind == FeatureKind::FACE || other.kind == FeatureKind::HALF_SPACE) {
    if (isRim(cylinder_, own)) overPlane(own.index, contact);
  } else {
    atPoint(contact);
  }
}

void RoundSide::overPlane(int vertex, Contact* contact) const {
  const Vector3 towards = towardsOther(*contact);
  const double lean = std::hypot(towards.x(), towards.y());
  if (lean < LEANS) return;
  const int sides = cylinder_.sides;
  const double step = 2 * M_PI / sides, lowest = std::atan2(towards.y(), towards.x());
  const int nearest_line = static_cast<int>(std::lround(lowest / step) + sides) % sides, line = vertex / 2;
  const int from_lowest = (line - nearest_line + sides) % sides;
  if (from_lowest == 0) {
    if (lean >= ROLLS && otherFeature(*contact).kind == FeatureKind::FACE && toWhatItMeets(vertex, towards, contact)) return;
    const double angle = step * line;
    const Vector3 way = cylinder_.radius * Vector3(std::cos(lowest) - std::cos(angle), std::sin(lowest) - std::sin(angle), 0);
    const double lower = way.dot(towards);
    contact->point += X_WK_.linear() * (way - 0.5 * lower * towards);
    contact->depth += lower;
  } else if (lean >= ROLLS_ALONE && (from_lowest == 1 || from_lowest == sides - 1) && otherFeature(*contact).kind == FeatureKind::FACE &&
             standsIn(vertex, 2 * nearest_line + vertex % 2, towards, contact)) {
    return;
  } else if (2 * from_lowest != sides || lean > SLAPS) {  // the opposite one stays: an end that slaps down stops there
    contact->depth -= lean < ROLLS_ALONE ? cylinder_.radius * std::max(0.0, lean - ROLLS) : std::numeric_limits<double>::infinity();
  }
  if (lean < ROLLS) return;
  rename(from_lowest == 0 ? rim(vertex % 2 == 1) : Feature{FeatureKind::VERTEX, 2 * from_lowest + vertex % 2}, otherFeature(*contact),
         contact);
}

/** Face of a contact, the rim's vertex that has it and the place on the other surface; in the cylinder's frame. */
NearestPlace RoundSide::placeOf(int vertex, const Contact& contact) const {
  return {otherFeature(contact), rimVertex(vertex), X_WK_.inverse() * witnessOf(contact, other_.collider.radius, !is_a_)};
}

/**
 * Moves a contact of a rim's vertex that is nearest to its lowest point, which may be beyond the face, or over it where the vertex is not.
 * @param towards unit, to the face, in the cylinder's frame @return false where the vertex tells what the rim meets
 */
bool RoundSide::toWhatItMeets(int vertex, const Vector3& towards, Contact* contact) const {
  const Vector3 own = X_WK_.inverse() * witnessOf(*contact, own_.collider.radius, is_a_);
  NearestPlace place = placeOf(vertex, *contact);
  const bool fades = (own - place.on_cylinder).norm() > ON_MESH;
  const Feature face = place.feature;
  if (!descent().descendFrom(-towards, &place)) return false;
  const bool is_over_face = place.feature.kind == face.kind && place.feature.index == face.index;
  return (fades || !is_over_face) && set(place, contact);
}

/**
 * Moves a contact of the vertex beside the one that is nearest to the rim's lowest point, where that one has none so deep with the
 * face: in a valley it may be over the other side. @return false where it stays
 */
bool RoundSide::standsIn(int vertex, int nearest, const Vector3& towards, Contact* contact) const {
  const Feature face = otherFeature(*contact);
  const auto isOfNearest = [&](const Contact& c) {
    const Feature own = ownFeature(c), other = otherFeature(c);
    return c.depth >= contact->depth && other.kind == face.kind && other.index == face.index && own.kind == FeatureKind::VERTEX &&
           (own.index == nearest || own.index == rim(nearest % 2 == 1).index);
  };
  if (std::any_of(contacts_.begin(), contacts_.end(), isOfNearest)) return false;
  NearestPlace place = placeOf(vertex, *contact);
  return descent().descendFrom(-towards, &place) && set(place, contact);
}

/** Whether a point of the cylinder's frame lies on the mesh's mantle. */
bool RoundSide::isOnMesh(const Vector3& p) const {
  const double half = M_PI / cylinder_.sides, turn = std::remainder(std::atan2(p.y(), p.x()) - half, 2 * half);
  const double mantle = cylinder_.radius * std::cos(half) / std::cos(turn);
  return std::abs(p.z()) <= cylinder_.half_length + ON_MESH && std::abs(std::hypot(p.x(), p.y()) - mantle) <= ON_MESH;
}

void RoundSide::atPoint(Contact* contact) const {
  const Pose X_KW = X_WK_.inverse();
  if (!isOnMesh(X_KW * witnessOf(*contact, own_.collider.radius, is_a_))) return;
  NearestPlace place{otherFeature(*contact), Vector3::Zero(), X_KW * witnessOf(*contact, other_.collider.radius, !is_a_)};
  if (!descent().approach(&place)) return;
  NearestPlace end = place;
  set(descent().descend(&end) ? end : place, contact);
}

/**
 * Moves a contact of mantle or rim with those of another cylinder; two mantles meet where their axes are nearest.
 * @param own_rim as rimOf() tells
 */
void RoundSide::atCylinder(int own_rim, Contact* contact) const {
  const geometry::Cylinder& other = *other_.collider.geometry->cylinder();
  const Pose X_KL = X_KO_ * other.X_GK;
  const Vector3 middle = X_KL.translation(), axis = X_KL.linear().col(2);
  const double across2 = axis.head<2>().squaredNorm();
  if (own_rim < 0 && across2 < MIN_EDGE_SINE * MIN_EDGE_SINE) return;
  const auto onOther = [&](double t) -> Vector3 { return middle + std::clamp(t, -other.half_length, other.half_length) * axis; };
  const auto towards = [&](const Vector3& p, double z) -> Vector3 {
    return cylinder_.radius / p.head<2>().norm() * Vector3(p.x(), p.y(), 0) + Vector3(0, 0, z);
  };
  Vector3 x;
  if (own_rim >= 0) {
    const double z = own_rim == 0 ? -cylinder_.half_length : cylinder_.half_length;
    x = Vector3(0, 0, z);
    constexpr int TIMES = 8;
    for (int i = 0; i < TIMES; ++i) x = towards(onOther(axis.dot(x - middle)), z);
  } else {
    const Vector3 near = onOther(-middle.head<2>().dot(axis.head<2>()) / across2);
    x = towards(near, std::clamp(near.z(), -cylinder_.half_length, cylinder_.half_length));
  }
  Vector3 q;
  if (x.allFinite() && projectOnto(other, X_KL.inverse() * x, &q)) set({otherFeature(*contact), x, X_KL * q}, contact);
}

/** Sets the contact to that of two points. @return false, and does nothing, if they are farther apart than those of the mesh */
bool RoundSide::set(const NearestPlace& place, Contact* contact) const {
  const Vector3 &x = place.on_cylinder, &q = place.on_surface;
  const double own_radius = own_.collider.radius, layer = own_radius + other_.collider.radius, gap = (x - q).norm();
  if (gap <= TOUCH || gap > layer - contact->depth + ON_MESH) return false;
  const Vector3 normal = (x - q) / gap;  // from the other to the cylinder
  contact->normal_BA = X_WK_.linear() * (is_a_ ? normal : Vector3(-normal));
  contact->depth = layer - gap;
  contact->point = X_WK_ * Vector3(x - (own_radius - 0.5 * contact->depth) * normal);
  rename(isAtRim(cylinder_, x) ? rim(x.z() > 0) : Feature{FeatureKind::FACE, 0}, place.feature, contact);
  return true;
}

/** The deepest contact of each name stays: several sides of a mesh may have had it. */
void dropRepeated(std::vector<Contact>* contacts) {
  std::sort(contacts->begin(), contacts->end(), [](const Contact& a, const Contact& b) {
    return a.id != b.id ? a.id < b.id : a.depth != b.depth ? a.depth > b.depth : contactBefore(a, b);
  });
  contacts->erase(std::unique(contacts->begin(), contacts->end(), [](const Contact& a, const Contact& b) { return a.id == b.id; }),
                  contacts->end());
}

/** The first contact at a place stays: sides of a static cylinder keep their names. */
void dropAtOnePlace(std::vector<Contact>* contacts) {
  constexpr double SAME = 1e-9;  // [m], and of normals
  std::size_t kept = 0;
  for (const Contact& contact : *contacts) {
    const auto isSame = [&](const Contact& c) {
      return (c.point - contact.point).squaredNorm() < SAME * SAME && (c.normal_BA - contact.normal_BA).squaredNorm() < SAME * SAME;
    };
    if (std::none_of(contacts->begin(), contacts->begin() + static_cast<std::ptrdiff_t>(kept), isSame)) (*contacts)[kept++] = contact;
  }
  contacts->resize(kept);
}

}  // namespace

void moveOntoCylinders(const PlacedCollider& a, const PlacedCollider& b, double range, ContactManifold* manifold) {
  if (manifold->contacts.empty() || (!a.collider.geometry->cylinder() && !b.collider.geometry->cylinder())) return;
  for (const bool is_a : {true, false}) {
    const PlacedCollider &own = is_a ? a : b, &other = is_a ? b : a;
    if (!own.collider.geometry->cylinder()) continue;
    const RoundSide side(own, other, is_a, manifold->contacts);
    for (Contact& contact : manifold->contacts) side.move(&contact);
  }
  std::vector<Contact>& contacts = manifold->contacts;
  contacts.erase(
      std::remove_if(contacts.begin(), contacts.end(), [&](const Contact& contact) { return manifold->layer - contact.depth > range; }),
      contacts.end());
  dropRepeated(&contacts);
  const bool one_is_static = a.collider.body < 0 || b.collider.body < 0;
  if (one_is_static && a.collider.geometry->cylinder() && b.collider.geometry->cylinder()) dropAtOnePlace(&contacts);
}

}  // namespace blem_sim::contact
