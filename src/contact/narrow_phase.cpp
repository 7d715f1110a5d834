#include "blem_sim/contact/narrow_phase.h"

#include <cmath>

#include "blem_sim/geometry/bvh_traversal.h"
#include "evaluation/retraction.h"
#include "evaluation/world_contact.h"
#include "merging/merge_contacts.h"
#include "search/contact_search.h"

namespace blem_sim::contact {
namespace {

// Copies at one place have bounds that agree within the first of these parts of their diagonal; moved by the second, they cross.
constexpr double AT_ONE_PLACE = 1e-6, APART = 1e-5;
constexpr double IN_EACH_OTHER = 1e-9;  // of the layers: a gap that is none

/** Buffers of a thread's searches. */
struct Buffers {
  ContactSearchBuffers search;
  FoundContacts found;
  std::vector<Contact> below_plane;
  ContactMerge merge;
};

Buffers& threadBuffers() {
  thread_local Buffers buffers;
  return buffers;
}

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

void meshMesh(const Collider& a, const Pose& X_WA, const Collider& b, const Pose& X_WB, double range, const Pose* X_AB_apart,
              ContactSearchMemory* memory, ContactManifold* out) {
  const bool a_moves = a.geometry->mesh().elements.size() <= b.geometry->mesh().elements.size();
  const Pose &X_WM = a_moves ? X_WA : X_WB, &X_WF = a_moves ? X_WB : X_WA;
  const MeshPair pair{MeshSide(a_moves ? *a.geometry : *b.geometry),
                      MeshSide(a_moves ? *b.geometry : *a.geometry),
                      X_WF.inverse() * X_WM,
                      a.radius + b.radius,
                      range,
                      {a_moves ? Side::MOVING : Side::FIXED, {a_moves ? a.radius : b.radius, a_moves ? b.radius : a.radius}},
                      X_WF};
  Buffers& buffers = threadBuffers();
  FoundContacts& found = buffers.found;
  const auto cross = [&](const MeshPair& at, ContactSearchMemory* known) {
    found.plain.overwrite(&out->contacts);
    searchContacts(at, known, &buffers.search, &found);
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
    if (X_AB_apart) X_FM_apart = a_moves ? X_AB_apart->inverse() : *X_AB_apart;
    addRetractions(pair, X_AB_apart ? &X_FM_apart : nullptr, found.crossings, &found.close.witnessed());
  }
  const ContactWriter& close = found.close.placed(pair);
  found.plain.advance(buffers.merge.run(close.begin(), close.size(), found.plain.room(close.size())));
  found.plain.finish();
  if (in_each_other && !out->pierced) takeBack(pair, &out->contacts);
}

/** Vertices of the mesh near or below the plane; however deep, each knows its way out. */
void meshHalfSpace(const Collider& mesh, const Pose& X_WM, const Collider& half_space, const Pose& X_WH, double range,
                   const ContactRoles& roles, ContactManifold* out) {
  const MeshSide side(*mesh.geometry);
  const Pose X_MH = X_WM.inverse() * X_WH;
  const Vector3 normal = X_MH.linear() * half_space.geometry->planeNormal();
  const double offset = half_space.geometry->planeOffset() + normal.dot(X_MH.translation());
  Buffers& buffers = threadBuffers();
  std::vector<Contact>& found = buffers.below_plane;
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
            contactOf(roles, {FeatureKind::VERTEX, vertex}, {FeatureKind::HALF_SPACE, 0}, p, p - height * normal, normal, height));
      }
    }
  });
  out->contacts.resize(found.size());
  out->contacts.resize(buffers.merge.run(found.data(), found.size(), out->contacts.data()));
  for (Contact& contact : out->contacts) {
    contact.point = X_WM * contact.point;
    contact.normal_BA = X_WM.linear() * contact.normal_BA;
  }
}

}  // namespace

struct NarrowPhaseMemory::Impl {
  ContactSearchMemory search;
};

NarrowPhaseMemory::NarrowPhaseMemory() : impl_(std::make_unique<Impl>()) {}
NarrowPhaseMemory::~NarrowPhaseMemory() = default;
NarrowPhaseMemory::NarrowPhaseMemory(NarrowPhaseMemory&&) noexcept = default;
NarrowPhaseMemory& NarrowPhaseMemory::operator=(NarrowPhaseMemory&&) noexcept = default;

void narrowPhase(const Collider& a, const Pose& X_WA, const Collider& b, const Pose& X_WB, double margin, ContactManifold* out,
                 const Pose* X_AB_apart, NarrowPhaseMemory* memory) {
  out->layer = a.radius + b.radius;
  out->pierced = false;
  const double range = out->layer + margin;
  if (a.geometry->isHalfSpace() && b.geometry->isHalfSpace()) {
    out->contacts.clear();
  } else if (b.geometry->isHalfSpace()) {
    meshHalfSpace(a, X_WA, b, X_WB, range, {Side::MOVING, {a.radius, b.radius}}, out);
  } else if (a.geometry->isHalfSpace()) {
    meshHalfSpace(b, X_WB, a, X_WA, range, {Side::FIXED, {b.radius, a.radius}}, out);
  } else {
    meshMesh(a, X_WA, b, X_WB, range, X_AB_apart, memory ? &memory->impl_->search : nullptr, out);
  }
}

}  // namespace blem_sim::contact
