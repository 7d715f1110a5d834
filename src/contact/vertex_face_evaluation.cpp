// Evaluation of vertices over faces, or little beside them.
#include <cmath>
#include <utility>

#include "contact_evaluation.h"
#include "vectors.h"

namespace blem_sim {
namespace {

using kernels::Candidate;
using kernels::VertexFaceHit;

constexpr std::uint32_t NONE = 0xFFFFFFFF;

}  // namespace

kernels::ContactPlace Evaluation::place(bool vertices_move) const {
  const ContactRoles& roles = pair_.roles;
  const Feature vertex{FeatureKind::VERTEX, 0}, face{FeatureKind::FACE, 0};
  const bool vertices_are_a = vertices_move == roles.first_is_a;
  return {lists_.near[!vertices_move].patches.data(),
          vertices_are_a,
          motionOf(pair_.X_FM),
          motionOf(pair_.X_WF),
          roles.r_a + roles.r_b,
          0.5 * (roles.r_b - roles.r_a),
          vertices_are_a ? contactId(vertex, face) : contactId(face, vertex),
          found_.close.keepsWitnesses()};
}

/** @return how many need a closer look; the plain ones are written */
std::uint32_t Evaluation::findVertexFaces(bool moves) {
  const std::vector<Candidate>& candidates = pairs_.vertex_face[moves];
  const kernels::NearVertices vertices = buffers_.turned.nearFaces(lists_, moves, pair_.X_FM);
  const std::vector<std::uint8_t>& inner = pairs_.inner[moves];
  const NearFeatures& partner = lists_.near[!moves];
  kernels::PlainContacts plain{place(moves), nullptr, 0, found_.deepest_plain};
  return testBlocks(candidates.size(), &buffers_.vertex_faces, &plain, [&](std::uint32_t first, std::uint32_t size, VertexFaceHit* hits) {
    return kernels::kernels().vertexFaces(vertices, partner.faces.records.data(), partner.open.data(), candidates.data() + first, size,
                                          inner.empty() ? nullptr : inner.data() + first, pair_.range,
                                          found_.crossings.empty() ? &plain : nullptr, hits);
  });
}

void Evaluation::vertexFaces(bool moves) {
  if (pairs_.vertex_face[moves].empty()) return;
  const std::uint32_t count = findVertexFaces(moves);
  const std::vector<Candidate>& candidates = pairs_.vertex_face[moves];
  const auto &vertices = lists_.near[moves].vertices.names, &faces = lists_.near[!moves].faces.names;
  auto& hits = buffers_.vertex_faces;
  buffers_.over.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    VertexFaceHit& hit = hits[i];
    const Candidate& c = candidates[hit.candidate];
    if (hit.has(VertexFaceHit::PLAIN)) {
      addPlain(moves, c, hit.height);
    } else if (!hit.has(VertexFaceHit::BESIDE)) {
      if (exact_.vertexFace(moves, vertices[c.a], faces[c.b])) {
        buffers_.over.push_back(c);
      } else {
        hit.bits |= VertexFaceHit::BESIDE;
      }
    }
  }
  listFadingSides(moves, count);
  if (buffers_.beside.empty()) return;
  addFading(moves);
  dropCovered(moves);
}

void Evaluation::addPlain(bool moves, const Candidate& c, double height) {
  const auto& faces = lists_.near[!moves].faces;
  const Feature vertex{FeatureKind::VERTEX, lists_.near[moves].vertices.names[c.a]},
      patch{FeatureKind::FACE, lists_.near[!moves].patches[c.b]};
  const Vector3 p = vector3(moves ? buffers_.turned.vertices[c.a] : lists_.near[0].vertices.records[c.a]);
  const Vector3 up = pair_.turned(vector3(faces.records[c.b].plane), !moves), foot = p - height * up;
  const Vector3 normal = (height > 0) == moves ? up : Vector3(-up);
  found_.close.add(pair_, moves, vertex, patch, p, foot, normal, std::abs(height));
}

/** Of the hits that fade, those sides that their vertices lie outside of. */
void Evaluation::listFadingSides(bool moves, std::uint32_t hits) {
  buffers_.beside.clear();
  buffers_.sides.clear();
  const MeshSide& side = pair_.side(!moves);
  for (std::uint32_t i = 0; i < hits; ++i) {
    const VertexFaceHit& hit = buffers_.vertex_faces[i];
    const Candidate& c = pairs_.vertex_face[moves][hit.candidate];
    if (!hit.has(VertexFaceHit::BESIDE) || !fades_.fades(moves, c, hit)) continue;
    const Vector3i& corners = side.mesh.elements[lists_.near[!moves].faces.names[c.b]];
    for (unsigned outside = hit.bits & VertexFaceHit::OUTSIDE; outside != 0; outside &= outside - 1) {
      const int k = __builtin_ctz(outside);
      const Vector3 &start = side.mesh.vertices[corners[k]], &end = side.mesh.vertices[corners[NEXT[k]]];
      buffers_.beside.push_back(c);
      kernels::BesideSide& added = buffers_.sides.emplace_back();
      added.start.x = start.x(), added.start.y = start.y(), added.start.z = start.z();
      added.along.x = end.x() - start.x(), added.along.y = end.y() - start.y(), added.along.z = end.z() - start.z();
    }
  }
}

/** Of each vertex with a face: at the nearest of the sides. */
void Evaluation::addFading(bool moves) {
  const std::vector<Candidate>& beside = buffers_.beside;
  EvaluationBuffers::makeRoom(beside.size(), &buffers_.feet);
  kernels::kernels().sideFeet(place(moves), buffers_.turned.nearFaces(lists_, moves, pair_.X_FM), lists_.near[!moves].faces.records.data(),
                              buffers_.sides.data(), beside.data(), static_cast<std::uint32_t>(beside.size()), buffers_.feet.data());
  buffers_.fading.clear();
  const auto& vertices = (moves ? buffers_.turned.vertices : lists_.near[0].vertices.records);
  for (std::size_t i = 0, next; i < beside.size(); i = next) {
    const kernels::SideFoot* nearest = &buffers_.feet[i];
    const Candidate& c = beside[i];
    for (next = i + 1; next < beside.size() && beside[next].a == c.a && beside[next].b == c.b; ++next)
      if (buffers_.feet[next].lost < nearest->lost) nearest = &buffers_.feet[next];
    const double gap = nearest->distance + nearest->lost;
    if (nearest->distance <= TOUCH || gap > pair_.range) continue;
    const int patch = lists_.near[!moves].patches[c.b];
    const Feature vertex{FeatureKind::VERTEX, lists_.near[moves].vertices.names[c.a]}, face{FeatureKind::FACE, patch};
    const Vector3 point(nearest->point), normal(nearest->normal);
    if (found_.close.keepsWitnesses()) {
      found_.close.add(pair_, moves, vertex, face, vector3(vertices[c.a]), point, normal, gap);
    } else {
      found_.close.addPlaced(point, normal, pair_.layer - gap, contactId(pair_.roles, moves, vertex, face));
    }
    FadingVertex& fading = buffers_.fading.emplace_back();
    fading.vertex = c.a;
    fading.face = c.b;
    fading.goes_on = lists_.near[!moves].borders[c.b].goesOn();
    fading.is_covered = false;
  }
}

/** What lies beside one face of a plane but over another does not fade. */
void Evaluation::dropCovered(bool moves) {
  auto& fading = buffers_.fading;
  auto& last = buffers_.last_fading;
  if (last.size() < lists_.near[moves].vertices.names.size()) last.resize(lists_.near[moves].vertices.names.size(), NONE);
  bool may_be_covered = false;
  for (std::uint32_t i = 0; i < fading.size(); ++i) {
    if (!fading[i].goes_on) continue;
    fading[i].before = std::exchange(last[fading[i].vertex], i);
    may_be_covered = true;
  }
  if (!may_be_covered) return;
  listCovering(moves);
  bool is_any_covered = false;
  for (const Candidate& c : buffers_.over) {
    forEachBeside(moves, c, [&](FadingVertex* each) { each->is_covered = is_any_covered = true; });
  }
  for (const FadingVertex& each : fading) last[each.vertex] = NONE;
  if (!is_any_covered) return;
  found_.close.keepOfLast(fading.size(), [&](std::size_t i) { return !fading[i].is_covered; });
}

/** Of vertices whose contacts may be covered, the plain ones with other faces of the same plane. */
void Evaluation::listCovering(bool moves) {
  auto& asked = buffers_.asked;
  asked.clear();
  for (const Candidate& c : pairs_.vertex_face[moves]) {
    bool is_asked = false;
    forEachBeside(moves, c, [&](FadingVertex*) { is_asked = true; });
    if (is_asked) asked.push_back(c);
  }
  EvaluationBuffers::makeRoom(asked.size() + 1, &buffers_.vertex_faces);
  VertexFaceHit* const hits = buffers_.vertex_faces.data();
  const NearFeatures& partner = lists_.near[!moves];
  const std::uint32_t count = kernels::kernels().vertexFaces(buffers_.turned.nearFaces(lists_, moves, pair_.X_FM),
                                                             partner.faces.records.data(), partner.open.data(), asked.data(),
                                                             static_cast<std::uint32_t>(asked.size()), nullptr, pair_.range, nullptr, hits);
  for (std::uint32_t i = 0; i < count; ++i)
    if (hits[i].has(VertexFaceHit::PLAIN)) buffers_.over.push_back(asked[hits[i].candidate]);
}

/** Calls visit for the contacts that fade beside other faces of the candidate's plane. */
template <typename Visit>
void Evaluation::forEachBeside(bool moves, const Candidate& c, Visit&& visit) {
  const std::vector<int>& patches = lists_.near[!moves].patches;
  for (std::uint32_t at = buffers_.last_fading[c.a]; at != NONE; at = buffers_.fading[at].before) {
    FadingVertex& each = buffers_.fading[at];
    if (each.face != c.b && patches[each.face] == patches[c.b]) visit(&each);
  }
}

}  // namespace blem_sim
