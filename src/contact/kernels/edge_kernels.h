// Edges near edges, several pairs at once, in double. Included by kernels_code.h only.
#pragma once

#include "kernels/edge_records.h"
#include "kernels/fading_edges.h"
#include "kernels/plain_contacts.h"

namespace blem_sim::contact::kernels {
namespace {

/** Closest points of the lines through edges: at parts s / n2 and t / n2 of them. */
struct Perpendiculars {
  explicit Perpendiculars(const EdgeBatch& edges) : n(cross(edges.along_m.v, edges.along_f.v)), n2(dot(n, n)), rn(dot(edges.between, n)) {
    s = dot(cross(edges.between, edges.along_f.v), n), t = dot(cross(edges.between, edges.along_m.v), n);
    over_s = beyondEnds(s, n2), over_t = beyondEnds(t, n2);
  }

  /** Whether these points are no farther from each other than the range [m], nor from the edges than contacts fade; never for parallel
   * edges. */
  Mask within(const EdgeBatch& edges, double range) const {
    const double most = range / FADE_SLOPE;
    const Doubles pp = edges.start_m.w, qq = edges.start_f.w, most2 = most * most * n2 * n2;
    return (rn * rn <= range * range * n2) & (n2 > MIN_EDGE_SINE * MIN_EDGE_SINE * pp * qq) & (over_s * over_s * pp <= most2) &
           (over_t * over_t * qq <= most2);
  }
  /** Whether a foot is within NEAR_BORDER of an end of its edge. */
  Mask nearBorder(const EdgeBatch& edges) const {
    const Doubles border2 = NEAR_BORDER * NEAR_BORDER * n2 * n2, end_s = minimum(s, n2 - s), end_t = minimum(t, n2 - t);
    return (end_s * end_s * edges.start_m.w < border2) | (end_t * end_t * edges.start_f.w < border2);
  }

  const Vectors n;
  const Doubles n2, rn;
  Doubles s, t, over_s, over_t;
};

/** Whether a normal from the fixed edge to the moving one points into no face of either edge. */
inline Mask conesAllow(const EdgeBatch& edges, const Vectors& normal) {
  Mask allowed = dot(edges.inward_f[0], normal) <= EDGE_CONE_SLACK;
  allowed &= dot(edges.inward_f[1], normal) <= EDGE_CONE_SLACK;
  allowed &= dot(edges.inward_m[0], normal) >= -EDGE_CONE_SLACK;
  allowed &= dot(edges.inward_m[1], normal) >= -EDGE_CONE_SLACK;
  return allowed;
}

/** @param bits of the lanes that have a contact @return depths */
inline Doubles appendEdges(const Batch& batch, const EdgeFeet& feet, unsigned bits, PlainEdges* out) {
  const EdgePlace& place = out->place;
  const Vectors normal_BA = all(place.a == Side::MOVING ? 1 : -1) * feet.normal;
  const Doubles depth = place.layer - feet.gap;
  const Mask first = batch.numbers(place.names_m, OF_FIRST), second = batch.numbers(place.names_f, OF_SECOND);
  const Mask ids = (place.a == Side::MOVING ? first << 32 | second : second << 32 | first) | static_cast<long>(place.kinds);
  const ContactNumbers* const end =
      appendRows(inWorld(place, feet.point_m, feet.point_f, normal_BA), depth, ids, bits, out->rows + out->count);
  out->count = static_cast<std::uint32_t>(end - out->rows);
  return depth;
}

/** @param bits of the lanes that have a hit @return number of hits now */
inline std::uint32_t appendHits(std::uint32_t first, const EdgeFeet& feet, unsigned bits, std::uint32_t found, EdgeEdgeHit* hits) {
  for (; bits != 0; bits &= bits - 1) {
    const int i = __builtin_ctz(bits);
    EdgeEdgeHit& hit = hits[found++];
    hit.candidate = first + i;
    const auto write = [i](const Vectors& v, double* out) { out[0] = v.x[i], out[1] = v.y[i], out[2] = v.z[i]; };
    write(feet.point_m, hit.point_m);
    write(feet.point_f, hit.point_f);
    write(feet.normal, hit.normal);
    hit.gap = feet.gap[i];
  }
  return found;
}

/** Copies a candidate for every lane; where its bit is not set the next one is written over it. */
inline void appendLeft(const Batch& batch, unsigned bits, LeftEdges* left) {
  for (int i = 0; i < LANES; ++i) {
    left->pairs[left->count] = batch.lanes[i];
    left->count += bits >> i & 1;
  }
}

std::uint32_t edgeEdges(const EdgeRecord* moving, const EdgeRecord* fixed, CandidateRun run, double range, const EdgeEdgeResults& out) {
  PlainEdges* const plain = out.plain;
  std::uint32_t found = 0;
  Doubles deepest = all(plain ? plain->deepest : 0);
  for (std::uint32_t first = 0; first < run.count; first += LANES) {
    const Batch batch(run, first);
    EdgeBatch edges(batch, moving, fixed);
    const Perpendiculars lines(edges);
    const Mask within = lines.within(edges, range);
    if ((bitsOf(within) & batch.valid) == 0) continue;
    edges.takeInwards(batch, moving, fixed);
    const Doubles norm = squareRoot(lines.n2), gap = absolute(lines.rn) / norm;
    const Vectors normal = (lines.rn > 0 ? all(-1) : all(1)) / norm * lines.n;
    const Mask touch = gap <= TOUCH, is = within & (conesAllow(edges, normal) | touch);
    const unsigned hit = bitsOf(is) & batch.valid;
    if (hit == 0) continue;
    const EdgeFeet feet{edges.start_m.v + lines.s / lines.n2 * edges.along_m.v, edges.start_f.v + lines.t / lines.n2 * edges.along_f.v,
                        normal, gap, gap};
    const Mask stands = (lines.over_s == 0) & (lines.over_t == 0) & ~touch & (maximum(edges.along_m.w, edges.along_f.w) <= 0),
               clear = is & stands & ~lines.nearBorder(edges);
    const unsigned is_clear = plain ? bitsOf(clear) & batch.valid : 0;
    if (is_clear) {
      const Doubles depth = appendEdges(batch, feet, is_clear, plain);
      deepest = maximum(deepest, clear ? depth : deepest);
    }
    const unsigned is_plain = hit & bitsOf(stands);
    found = appendHits(first, feet, is_plain & ~is_clear, found, out.hits);
    appendLeft(batch, hit & ~is_plain, out.left);
  }
  raiseDeepest(deepest, plain);
  return found;
}

}  // namespace
}  // namespace blem_sim::contact::kernels
