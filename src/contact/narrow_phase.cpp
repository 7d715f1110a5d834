#include "blem_sim/contact/narrow_phase.h"

#include <cmath>

#include "blem_sim/geometry/bvh_traversal.h"
#include "cylinders/on_cylinders.h"
#include "evaluation/retraction.h"
#include "evaluation/world_contact.h"
#include "kept/still_pair.h"
#include "merging/merge_contacts.h"
#include "search/contact_search.h"

namespace blem_sim::contact {

/** Room of searches. */
struct SearchRoom {
  ContactSearchBuffers search;
  EvaluatedContacts found;
  std::vector<Contact> below_plane;
  ContactMerge merge;
};

namespace {

// Copies at one place have bounds that agree within the first of these parts of their diagonal; moved by the second, they cross.
constexpr double AT_ONE_PLACE = 1e-6, APART = 1e-5;
constexpr double IN_EACH_OTHER = 1e-9;  // of the layers: a gap that is none

/** Whether two bodies share one place: their faces coincide, so that none crosses another, however deep the bodies are in each other. */
bool areAtOnePlace(const MeshPair& pair) {
  const Box &moving = pair.moving.bounds, &fixed = pair.fixed.bounds;
  const double tolerance = AT_ONE_PLACE * fixed.diagonal().norm();
  if ((pair.X_FM * moving.center() - fixed.center()).norm() > tolerance) return false;
  return (pair.X_FM.linear().cwiseAbs() * moving.diagonal() - fixed.diagonal()).norm() <= tolerance;
}

/** [m] By how much the moving mesh is moved so that copies at one place cross, axes of the fixed one. */
Vector3 littleWay(const MeshPair& pair) { return APART * pair.fixed.bounds.diagonal().norm() * Vector3(0.48, 0.6, 0.64); }

MeshPair aLittleApart(const MeshPair& pair) {
  MeshPair apart = pair;
  apart.X_FM.translation() += littleWay(pair);
  return apart;
}

/** Depths of contacts that were found a little apart, as they are where the meshes lie. */
void takeBack(const MeshPair& pair, std::vector<Contact>* contacts) {
  const Vector3 way = (pair.roles.a == Side::MOVING ? 1 : -1) * (pair.X_WF.linear() * littleWay(pair));
  for (Contact& contact : *contacts) contact.depth += contact.normal_BA.dot(way);
}

/** The pair as the search sees it. */
MeshPair meshPair(const PlacedCollider& a, const PlacedCollider& b, double margin) {
  const Collider &first = a.collider, &second = b.collider;
  const bool a_moves = first.geometry->mesh().elements.size() <= second.geometry->mesh().elements.size();
  const PlacedCollider &moving = a_moves ? a : b, &fixed = a_moves ? b : a;
  const double layer = first.radius + second.radius;
  return {MeshSide(*moving.collider.geometry),
          MeshSide(*fixed.collider.geometry),
          fixed.X_WC.inverse() * moving.X_WC,
          layer,
          layer + margin,
          {a_moves ? Side::MOVING : Side::FIXED, {moving.collider.radius, fixed.collider.radius}},
          fixed.X_WC};
}

/** @param X_AB_apart as narrowPhase knows it @param memory of the pair, or null */
void meshMesh(const MeshPair& pair, const Pose* X_AB_apart, ContactSearchMemory* memory, SearchRoom* room, ContactManifold* out) {
  EvaluatedContacts& found = room->found;
  const auto cross = [&](const MeshPair& at, ContactSearchMemory* known) {
    found.plain.overwrite(&out->contacts);
    searchContacts(at, known, &room->search, &found);
    return !found.crossings.empty();
  };
  const bool copies = areAtOnePlace(pair);
  if (!copies || !cross(aLittleApart(pair), nullptr)) cross(pair, memory);
  // Copies of a sheet lie in each other without a crossing, and each vertex is pushed to its own side.
  const bool in_each_other = copies && std::abs(found.leastGap(pair)) <= IN_EACH_OTHER * pair.layer;
  if (in_each_other) cross(aLittleApart(pair), nullptr);
  out->pierced = !found.crossings.empty();
  if (out->pierced) {
    Pose X_FM_apart;
    if (X_AB_apart) X_FM_apart = pair.roles.a == Side::MOVING ? X_AB_apart->inverse() : *X_AB_apart;
    addRetractions(pair, X_AB_apart ? &X_FM_apart : nullptr, found.crossings, &found.close.witnessed());
  }
  const ContactWriter& close = found.close.placed(pair);
  found.plain.advance(room->merge.run(close.begin(), close.size(), found.plain.room(close.size())));
  found.plain.finish();
  if (in_each_other && !out->pierced) takeBack(pair, &out->contacts);
}

/** A mesh over a half-space. */
struct MeshOverPlane {
  const PlacedCollider &mesh, &half_space;
  ContactRoles roles;
};

/** Vertices of the mesh near or below the plane; however deep, each knows its way out. */
void meshHalfSpace(const MeshOverPlane& pair, double range, SearchRoom* room, ContactManifold* out) {
  const MeshSide side(*pair.mesh.collider.geometry);
  const Pose& X_WM = pair.mesh.X_WC;
  const Pose X_MH = X_WM.inverse() * pair.half_space.X_WC;
  const CollisionGeometry& plane = *pair.half_space.collider.geometry;
  const Vector3 normal = X_MH.linear() * plane.planeNormal();
  const double offset = plane.planeOffset() + normal.dot(X_MH.translation());
  std::vector<Contact>& found = room->below_plane;
  found.clear();
  geometry::visitLeavesBelowPlane(side.bvh, normal, offset, range, [&](std::uint32_t leaf) {
    const geometry::Bvh::Node& node = side.bvh.nodes()[leaf];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const int element = static_cast<int>(side.bvh.order()[i]);
      for (int k = 0; k < 3; ++k) {
        if (!side.topology.ownsVertex(element, k)) continue;
        const int vertex = side.mesh.elements[element][k];
        const Vector3& p = side.mesh.vertices[vertex];
        const double height = normal.dot(p) - offset;
        if (height > range) continue;
        found.push_back(
            contactOf(pair.roles, {{FeatureKind::VERTEX, vertex}, {FeatureKind::HALF_SPACE, 0}, p, p - height * normal, normal, height}));
      }
    }
  });
  out->contacts.resize(found.size());
  out->contacts.resize(room->merge.run(found.data(), found.size(), out->contacts.data()));
  for (Contact& contact : out->contacts) {
    contact.point = X_WM * contact.point;
    contact.normal_BA = X_WM.linear() * contact.normal_BA;
  }
}

/** [m] By how much contacts of a cylinder's mesh may be farther than those of the cylinder. */
double bulgeOf(const CollisionGeometry& geometry) { return geometry.cylinder() ? geometry.cylinder()->bulge() : 0; }

/** [m] By which the mesh of a cylinder may be farther than its rim's lowest point, at the vertex beside the one that is nearest to it. */
double besideLowestOf(const CollisionGeometry& geometry) {
  const geometry::Cylinder* const cylinder = geometry.cylinder();
  return cylinder ? cylinder->radius * (1 - std::cos(2 * M_PI / cylinder->sides)) : 0;
}

}  // namespace

struct NarrowPhaseMemory::Impl {
  StillPair still;
  ContactSearchMemory search;

  /** meshMesh() if the pair has moved or is new. */
  void find(const MeshPair& pair, const Pose* X_AB_apart, SearchRoom* room, ContactManifold* out) {
    const bool same = still.isSame(pair);
    if (same && still.hasContacts()) return still.recall(out);
    meshMesh(pair, X_AB_apart, &search, room, out);
    if (same) still.keep(*out);
  }
};

NarrowPhaseMemory::NarrowPhaseMemory() : impl_(std::make_unique<Impl>()) {}
NarrowPhaseMemory::~NarrowPhaseMemory() = default;
NarrowPhaseMemory::NarrowPhaseMemory(NarrowPhaseMemory&&) noexcept = default;
NarrowPhaseMemory& NarrowPhaseMemory::operator=(NarrowPhaseMemory&&) noexcept = default;

struct NarrowPhaseWorkspace::Impl {
  SearchRoom room;
};

NarrowPhaseWorkspace::NarrowPhaseWorkspace() = default;
NarrowPhaseWorkspace::~NarrowPhaseWorkspace() = default;
NarrowPhaseWorkspace::NarrowPhaseWorkspace(NarrowPhaseWorkspace&&) noexcept = default;
NarrowPhaseWorkspace& NarrowPhaseWorkspace::operator=(NarrowPhaseWorkspace&&) noexcept = default;

void narrowPhase(const PlacedCollider& a, const PlacedCollider& b, const NarrowPhaseQuestion& asked, NarrowPhaseWorkspace* workspace,
                 ContactManifold* out) {
  if (!workspace->impl_) workspace->impl_ = std::make_unique<NarrowPhaseWorkspace::Impl>();
  SearchRoom* const room = &workspace->impl_->room;
  const double r_a = a.collider.radius, r_b = b.collider.radius;
  out->layer = r_a + r_b;
  out->pierced = false;
  const double range = out->layer + asked.margin, bulges = bulgeOf(*a.collider.geometry) + bulgeOf(*b.collider.geometry);
  const bool a_is_half_space = a.collider.geometry->isHalfSpace(), b_is_half_space = b.collider.geometry->isHalfSpace();
  if (a_is_half_space && b_is_half_space) {
    out->contacts.clear();
  } else if (b_is_half_space) {
    meshHalfSpace({a, b, {Side::MOVING, {r_a, r_b}}}, range + bulges, room, out);
  } else if (a_is_half_space) {
    meshHalfSpace({b, a, {Side::FIXED, {r_b, r_a}}}, range + bulges, room, out);
  } else {
    const MeshPair pair = meshPair(a, b, asked.margin + besideLowestOf(*a.collider.geometry) + besideLowestOf(*b.collider.geometry));
    if (asked.memory)
      asked.memory->impl_->find(pair, asked.X_AB_apart, room, out);
    else
      meshMesh(pair, asked.X_AB_apart, nullptr, room, out);
  }
  moveOntoCylinders(a, b, range, out);
}

}  // namespace blem_sim::contact
