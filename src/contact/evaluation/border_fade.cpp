#include "evaluation/border_fade.h"

#include <cmath>

#include "evaluation/leaving_vertex.h"
#include "kernels/kernels.h"
#include "kernels/vectors.h"

namespace blem_sim::contact {

using kernels::Candidate;
using kernels::LeavingSide;
using kernels::VertexFaceHit;

void BorderFades::list(Side side, const VertexFaceHits& hits, LeavingBuffers* buffers, BesideFaces* fading) {
  listOpen(side, hits, buffers, fading);
  answer(side, buffers, *fading);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < fading->pairs.size(); ++i) {
    fading->pairs[kept] = fading->pairs[i];
    fading->sides[kept] = fading->sides[i];
    kept += buffers->fades[i];
  }
  fading->resize(kept);
}

/** Lists the pairs that fade unless something takes over, and the questions about them. Numbers are written one by one where they stay: a
 * copy of several would wait for each. */
void BorderFades::listOpen(Side side, const VertexFaceHits& hits, LeavingBuffers* buffers, BesideFaces* fading) {
  fading->resize(hits.count);
  buffers->makeRoom(hits.count);
  NearFeatures &own = lists_.near[side], &partner = lists_.near[!side];
  for (NearFeatures* near : {&own, &partner}) near->fading.makePlaces(near->vertices.names.size(), near->faces.names.size());
  std::uint32_t pairs = 0;
  LeavingSide* question = buffers->questions.data();
  for (const VertexFaceHit* hit = hits.data; hit != hits.data + hits.count; ++hit) {
    if (!hit->has(VertexFaceHit::BESIDE)) continue;
    const Candidate& c = hits.candidates[hit->candidate];
    const bool is_above = hit->height > 0;
    const BorderKinds::Seen& kinds = partner.borders[c.second].seen[is_above];
    const std::uint32_t outside = hit->bits & VertexFaceHit::OUTSIDE;
    if ((outside & (kinds.flat | kinds.round)) != 0 || (outside & (kinds.falling | kinds.rising)) == 0) continue;
    const bool fades = (outside & kinds.rising) != 0;
    if (!fades) {
      const FadingRecords::Directions& edges =
          own.fading.directionsAt(pair_.side(side), c.first, own.vertices.names[c.first], &surroundings_);
      for (unsigned falling = outside & kinds.falling; falling != 0; falling &= falling - 1, ++question) {
        question->pair = pairs;
        question->side = static_cast<std::uint16_t>(__builtin_ctz(falling));
        question->is_above = is_above;
        question->first = edges.first;
        question->blocks = edges.blocks;
      }
    }
    buffers->fades[pairs] = fades;
    Candidate& pair = fading->pairs[pairs];
    pair.first = c.first;
    pair.second = c.second;
    kernels::BesideSides& sides = fading->sides[pairs];
    sides.outside = outside;
    const std::uint32_t face =
        partner.fading.shapeOf(pair_.side(!side), c.second, partner.faces.names[c.second], kinds.flat != 0, &surroundings_);
    sides.face = face;
    sides.reach = partner.fading.reach(face).at(std::abs(hit->height));
    ++pairs;
  }
  fading->resize(pairs);
  buffers->question_count = static_cast<std::uint32_t>(question - buffers->questions.data());
}

/** Marks the pairs where nothing takes over from a vertex that leaves over a border behind which the surface falls: isTakenOver in a few
 * products, since over such a border the partner allows the vertex's own contact. */
void BorderFades::answer(Side side, LeavingBuffers* buffers, const BesideFaces& fading) {
  if (buffers->question_count == 0) return;
  const kernels::Motion to_vertices = motionOf(Pose(side == Side::MOVING ? R_MF_ : R_FM_));
  kernels::kernels().leadingAtSides(lists_.near[side].fading.directions(), lists_.near[!side].faces.records.data(), to_vertices,
                                    {fading.pairs.data(), buffers->questions.data(), buffers->question_count}, buffers->answers.data());
  for (std::uint32_t i = 0; i < buffers->question_count; ++i) {
    const LeavingSide& leaving = buffers->questions[i];
    const kernels::LeadingEdges& leading = buffers->answers[i];
    if (leading.near ? !isTakenOver(side, fading.pairs[leaving.pair], leaving) : leading.down) buffers->fades[leaving.pair] = 1;
  }
}

bool BorderFades::isTakenOver(Side side, const Candidate& c, const LeavingSide& leaving) {
  const MeshSide &own = pair_.side(side), &partner = pair_.side(!side);
  const NearFeatures& faces = lists_.near[!side];
  const Vector3 normal = vector3(faces.faces.records[c.second].plane), down = leaving.is_above ? Vector3(-normal) : normal;
  const Matrix3& R_PS = side == Side::MOVING ? R_FM_ : R_MF_;
  const int edge = partner.topology.edgeOf(faces.faces.names[c.second], leaving.side);
  return blem_sim::contact::isTakenOver({own, partner, lists_.near[side].vertices.names[c.first], edge, R_PS, R_PS.transpose() * down},
                                        &surroundings_);
}

}  // namespace blem_sim::contact
