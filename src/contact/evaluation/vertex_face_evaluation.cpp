// Evaluation of vertices over faces, or little beside them.
#include <cmath>
#include <utility>

#include "evaluation/contact_evaluation.h"
#include "kernels/vectors.h"

namespace blem_sim::contact {
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

/** @return number of those that need a closer look; the plain ones are written */
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
  if (count == 0) return;
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
  fades_.list(moves, candidates.data(), hits.data(), count, &buffers_.leaving, &buffers_.fading);
  if (buffers_.fading.pairs.empty()) return;
  dropCovered(moves, addFading(moves));
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

/** Adds the contact of each vertex with a face at the nearest of the sides. @return number of contacts */
std::uint32_t Evaluation::addFading(bool moves) {
  const auto size = static_cast<std::uint32_t>(buffers_.fading.pairs.size());
  const bool keeps_feet = found_.close.keepsWitnesses();
  if (keeps_feet) EvaluationBuffers::makeRoom(size + 1, &buffers_.feet);
  buffers_.asked_fading.resize(size);
  const NearFeatures& partner = lists_.near[!moves];
  kernels::FadingContacts out{keeps_feet ? buffers_.feet.data() : found_.close.rows(size + 1), buffers_.asked_fading.data(), 0};
  const std::uint32_t count = kernels::kernels().sideFeet(
      place(moves), buffers_.turned.nearFaces(lists_, moves, pair_.X_FM), partner.faces.records.data(), partner.fading.corners(),
      buffers_.fading.sides.data(), buffers_.fading.pairs.data(), size, pair_.range, &out);
  buffers_.asked_fading.resize(out.asked_count);
  if (keeps_feet) {
    addFeet(moves);
  } else {
    found_.close.advance(count);
  }
  return count;
}

void Evaluation::addFeet(bool moves) {
  const auto& vertices = moves ? buffers_.turned.vertices : lists_.near[0].vertices.records;
  for (const kernels::FadingContact& each : buffers_.asked_fading) {
    const Candidate& c = buffers_.fading.pairs[each.pair];
    const kernels::ContactRow& foot = buffers_.feet[each.row];
    found_.close.add(pair_, moves, {FeatureKind::VERTEX, lists_.near[moves].vertices.names[c.a]},
                     {FeatureKind::FACE, lists_.near[!moves].patches[c.b]}, vector3(vertices[c.a]), Vector3(foot.point),
                     Vector3(foot.normal), foot.depth);
  }
}

/** Drops fading contacts of vertices that lie beside one face of a plane but over another. @param count the last contacts fade */
void Evaluation::dropCovered(bool moves, std::uint32_t count) {
  const auto& asked = buffers_.asked_fading;
  if (asked.empty()) return;
  const std::vector<Candidate>& pairs = buffers_.fading.pairs;
  auto& last = buffers_.last_fading;
  auto& covers = buffers_.covers;
  EvaluationBuffers::makeRoom(lists_.near[moves].vertices.names.size(), &last, NONE);
  covers.resize(asked.size());
  for (std::uint32_t i = 0; i < asked.size(); ++i) covers[i] = {std::exchange(last[pairs[asked[i].pair].a], i), false};
  listCovering(moves);
  bool is_any_covered = false;
  for (const Candidate& c : buffers_.over) forEachBeside(moves, c, [&](FadingCover* cover) { cover->is_covered = is_any_covered = true; });
  for (const kernels::FadingContact& each : asked) last[pairs[each.pair].a] = NONE;
  if (!is_any_covered) return;
  std::size_t next = 0;
  found_.close.keepOfLast(count, [&](std::size_t i) {
    if (next == asked.size() || asked[next].row != i) return true;
    return !covers[next++].is_covered;
  });
}

/** Lists plain contacts, with other faces of the same plane, of vertices whose fading contacts may be covered. */
void Evaluation::listCovering(bool moves) {
  auto& asked = buffers_.asked;
  asked.clear();
  for (const Candidate& c : pairs_.vertex_face[moves]) {
    bool is_asked = false;
    forEachBeside(moves, c, [&](FadingCover*) { is_asked = true; });
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
  for (std::uint32_t at = buffers_.last_fading[c.a]; at != NONE; at = buffers_.covers[at].before) {
    const std::uint32_t face = buffers_.fading.pairs[buffers_.asked_fading[at].pair].b;
    if (face != c.b && patches[face] == patches[c.b]) visit(&buffers_.covers[at]);
  }
}

}  // namespace blem_sim::contact
