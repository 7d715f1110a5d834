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

kernels::ContactPlace Evaluation::place(Side side) const {
  const ContactRoles& roles = pair_.roles;
  const Feature vertex{FeatureKind::VERTEX, 0}, face{FeatureKind::FACE, 0};
  return {lists_.near[!side].patches.data(),
          side,
          roles.a,
          motionOf(pair_.X_FM),
          motionOf(pair_.X_WF),
          roles.layer(),
          roles.shift(),
          contactId(roles, side, vertex, face),
          found_.close.keepsWitnesses()};
}

/** @return number of those that need a closer look; the plain ones are written */
std::uint32_t Evaluation::findVertexFaces(Side side) {
  const std::vector<Candidate>& candidates = pairs_.vertex_face[side];
  const kernels::VerticesAtFaces features = buffers_.turned.atFaces(lists_, side, pair_.X_FM);
  const std::vector<std::uint8_t>& inner = pairs_.inner[side];
  kernels::PlainContacts plain{place(side), nullptr, 0, found_.deepest_plain};
  return testBlocks(candidates.size(), &buffers_.vertex_faces, &plain, [&](std::uint32_t first, std::uint32_t size, VertexFaceHit* hits) {
    const kernels::VertexFaceRun run{{candidates.data() + first, size}, inner.empty() ? nullptr : inner.data() + first};
    return kernels::kernels().vertexFaces(features, run, pair_.range, found_.crossings.empty() ? &plain : nullptr, hits);
  });
}

void Evaluation::vertexFaces(Side side) {
  if (pairs_.vertex_face[side].empty()) return;
  const std::uint32_t count = findVertexFaces(side);
  if (count == 0) return;
  const std::vector<Candidate>& candidates = pairs_.vertex_face[side];
  const auto &vertices = lists_.near[side].vertices.names, &faces = lists_.near[!side].faces.names;
  auto& hits = buffers_.vertex_faces;
  buffers_.over.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    VertexFaceHit& hit = hits[i];
    const Candidate& c = candidates[hit.candidate];
    if (hit.has(VertexFaceHit::PLAIN)) {
      addPlain(side, c, hit.height);
    } else if (!hit.has(VertexFaceHit::BESIDE)) {
      if (exact_.vertexFace(side, vertices[c.first], faces[c.second])) {
        buffers_.over.push_back(c);
      } else {
        hit.bits |= VertexFaceHit::BESIDE;
      }
    }
  }
  fades_.list(side, {candidates.data(), hits.data(), count}, &buffers_.leaving, &buffers_.fading);
  if (buffers_.fading.pairs.empty()) return;
  dropCovered(side, addFading(side));
}

void Evaluation::addPlain(Side side, const Candidate& c, double height) {
  const auto& faces = lists_.near[!side].faces;
  const Feature vertex{FeatureKind::VERTEX, lists_.near[side].vertices.names[c.first]},
      patch{FeatureKind::FACE, lists_.near[!side].patches[c.second]};
  const Vector3 p = vector3(side == Side::MOVING ? buffers_.turned.vertices[c.first] : lists_.near.fixed.vertices.records[c.first]);
  const Vector3 up = pair_.turned(vector3(faces.records[c.second].plane), !side), foot = p - height * up;
  const Vector3 normal = (height > 0) == (side == Side::MOVING) ? up : Vector3(-up);
  found_.close.add(pair_, contactBetween(side, {vertex, p}, {patch, foot}, normal, std::abs(height)));
}

/** Adds the contact of each vertex with a face at the nearest of the sides. @return number of contacts */
std::uint32_t Evaluation::addFading(Side side) {
  const auto size = static_cast<std::uint32_t>(buffers_.fading.pairs.size());
  const bool keeps_feet = found_.close.keepsWitnesses();
  if (keeps_feet) EvaluationBuffers::makeRoom(size + 1, &buffers_.feet);
  buffers_.asked_fading.resize(size);
  const NearFeatures& partner = lists_.near[!side];
  kernels::FadingContacts out{keeps_feet ? buffers_.feet.data() : found_.close.rows(size + 1), buffers_.asked_fading.data(), 0};
  const kernels::VerticesBesideFaces features{buffers_.turned.nearFaces(lists_, side, pair_.X_FM), partner.faces.records.data(),
                                              partner.fading.corners(), buffers_.fading.sides.data()};
  const std::uint32_t count = kernels::kernels().sideFeet(place(side), features, {buffers_.fading.pairs.data(), size}, pair_.range, &out);
  buffers_.asked_fading.resize(out.asked_count);
  if (keeps_feet) {
    addFeet(side);
  } else {
    found_.close.advance(count);
  }
  return count;
}

void Evaluation::addFeet(Side side) {
  const auto& vertices = side == Side::MOVING ? buffers_.turned.vertices : lists_.near.fixed.vertices.records;
  for (const kernels::FadingContact& each : buffers_.asked_fading) {
    const Candidate& c = buffers_.fading.pairs[each.pair];
    const kernels::ContactNumbers& foot = buffers_.feet[each.row];
    const Feature vertex{FeatureKind::VERTEX, lists_.near[side].vertices.names[c.first]},
        patch{FeatureKind::FACE, lists_.near[!side].patches[c.second]};
    const Witness at{vertex, vector3(vertices[c.first])}, on{patch, Vector3(foot.point)};
    found_.close.add(pair_, contactBetween(side, at, on, Vector3(foot.normal), foot.depth));
  }
}

/** Drops fading contacts of vertices that lie beside one face of a plane but over another. @param count the last contacts fade */
void Evaluation::dropCovered(Side side, std::uint32_t count) {
  const auto& asked = buffers_.asked_fading;
  if (asked.empty()) return;
  const std::vector<Candidate>& pairs = buffers_.fading.pairs;
  auto& last = buffers_.last_fading;
  auto& covers = buffers_.covers;
  EvaluationBuffers::makeRoom(lists_.near[side].vertices.names.size(), &last, NONE);
  covers.resize(asked.size());
  for (std::uint32_t i = 0; i < asked.size(); ++i) covers[i] = {std::exchange(last[pairs[asked[i].pair].first], i), false};
  listCovering(side);
  bool is_any_covered = false;
  for (const Candidate& c : buffers_.over) forEachBeside(side, c, [&](FadingCover* cover) { cover->is_covered = is_any_covered = true; });
  for (const kernels::FadingContact& each : asked) last[pairs[each.pair].first] = NONE;
  if (!is_any_covered) return;
  std::size_t next = 0;
  found_.close.keepOfLast(count, [&](std::size_t i) {
    if (next == asked.size() || asked[next].row != i) return true;
    return !covers[next++].is_covered;
  });
}

/** Lists plain contacts, with other faces of the same plane, of vertices whose fading contacts may be covered. */
void Evaluation::listCovering(Side side) {
  auto& asked = buffers_.asked;
  asked.clear();
  for (const Candidate& c : pairs_.vertex_face[side]) {
    bool is_asked = false;
    forEachBeside(side, c, [&](FadingCover*) { is_asked = true; });
    if (is_asked) asked.push_back(c);
  }
  EvaluationBuffers::makeRoom(asked.size() + 1, &buffers_.vertex_faces);
  VertexFaceHit* const hits = buffers_.vertex_faces.data();
  const kernels::VertexFaceRun run{{asked.data(), static_cast<std::uint32_t>(asked.size())}, nullptr};
  const std::uint32_t count =
      kernels::kernels().vertexFaces(buffers_.turned.atFaces(lists_, side, pair_.X_FM), run, pair_.range, nullptr, hits);
  for (std::uint32_t i = 0; i < count; ++i)
    if (hits[i].has(VertexFaceHit::PLAIN)) buffers_.over.push_back(asked[hits[i].candidate]);
}

/** Calls visit for the contacts that fade beside other faces of the candidate's plane. */
template <typename Visit>
void Evaluation::forEachBeside(Side side, const Candidate& c, Visit&& visit) {
  const std::vector<int>& patches = lists_.near[!side].patches;
  for (std::uint32_t at = buffers_.last_fading[c.first]; at != NONE; at = buffers_.covers[at].before) {
    const std::uint32_t face = buffers_.fading.pairs[buffers_.asked_fading[at].pair].second;
    if (face != c.second && patches[face] == patches[c.second]) visit(&buffers_.covers[at]);
  }
}

}  // namespace blem_sim::contact
