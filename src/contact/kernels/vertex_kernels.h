// Leading edges around vertices, and vertices near edges, in double. Included by kernels_code.h only.
#pragma once

#include "kernels/candidate_kernels.h"
#include "kernels/edge_directions.h"
#include "kernels/edge_records.h"

namespace blem_sim::contact::kernels {
namespace {

/** Calls visit(directions, their first lane in the block) for all edges. */
template <typename Visit>
inline void forEachDirections(const EdgeDirections* blocks, int count, Visit&& visit) {
  static_assert(DIRECTION_BLOCK % LANES == 0);
  const auto lanes = [](const double* from) { return *reinterpret_cast<const Doubles*>(from); };
  for (const EdgeDirections* block = blocks; block != blocks + count; ++block)
    for (int i = 0; i < DIRECTION_BLOCK; i += LANES)
      visit(Vectors{lanes(block->x + i), lanes(block->y + i), lanes(block->z + i)}, lanes(block->near + i));
}

inline Vectors allOf(const double* v) { return {all(v[0]), all(v[1]), all(v[2])}; }

LeadingEdges leadingEdges(const EdgeDirections* blocks, int count, const double* down, const double* aside) {
  const Vectors downs = allOf(down), asides = allOf(aside);
  Mask leads{}, is_near{};
  forEachDirections(blocks, count, [&](const Vectors& direction, Doubles near) {
    const Doubles sine = dot(direction, downs), beside = dot(direction, asides);
    const Mask is_down = sine > CONE_SLACK;
    leads |= is_down;
    is_near |= is_down & (sine <= near * (sine * sine + beside * beside));
  });
  return {bitsOf(leads) != 0, bitsOf(is_near) != 0};
}

void leadingAtSides(const EdgeDirections* directions, const FaceRecord* faces, const Motion& to_vertices, const LeavingRun& leaving,
                    LeadingEdges* leading) {
  const LeavingSide* const sides = leaving.sides;
  const std::uint32_t count = leaving.count;
  for (std::uint32_t first = 0; first < count; first += LANES) {
    const Vec4 *planes[LANES], *inward[LANES];
    for (std::uint32_t i = 0; i < LANES; ++i) {
      const LeavingSide& side = sides[first + i < count ? first + i : first];
      const FaceRecord& face = faces[leaving.pairs[side.pair].second];
      planes[i] = &face.plane;
      inward[i] = &face.sides[side.side];
    }
    const Vectors up = turnedDirection(to_vertices, gathered(planes).v), aside = turnedDirection(to_vertices, gathered(inward).v);
    for (std::uint32_t i = 0; i < LANES && first + i < count; ++i) {
      const LeavingSide& side = sides[first + i];
      const double sign = side.is_above ? -1 : 1, down[] = {sign * up.x[i], sign * up.y[i], sign * up.z[i]},
                   beside[] = {aside.x[i], aside.y[i], aside.z[i]};
      leading[first + i] = leadingEdges(directions + side.first, static_cast<int>(side.blocks), down, beside);
    }
  }
}

bool leadTo(const EdgeDirections* blocks, int count, const double* towards, double least2) {
  const Vectors to = allOf(towards);
  Mask leads{};
  forEachDirections(blocks, count, [&](const Vectors& direction, Doubles) {
    const Doubles part = dot(direction, to);
    leads |= (part > 0) & (part * part > least2);
  });
  return bitsOf(leads) != 0;
}

/** Offset from the foot on an edge, which may lie beyond its ends, and that foot's place as part of the edge. */
struct EdgeOffset {
  Vectors d;
  Doubles part;
};

inline EdgeOffset offsetFrom(const Rows& start, const Vectors& along, const Vectors& p) {
  const Vectors r = p - start.v;
  const Doubles part = dot(r, along) / start.w;
  return {r - part * along, part};
}

std::uint32_t vertexEdges(const Vec4* vertices, const EdgeRecord* edges, CandidateRun run, double range, VertexEdgeHit* hits) {
  std::uint32_t found = 0;
  double offsets[3][LANES];
  const auto test = [&](const Batch& batch) {
    const Rows start = batch.field(edges, OF_SECOND, &EdgeRecord::start);
    const Rows along = batch.field(edges, OF_SECOND, &EdgeRecord::along);
    const EdgeOffset offset = offsetFrom(start, along.v, batch.points(vertices, OF_FIRST).v);
    const Doubles d2 = dot(offset.d, offset.d), over = beyondEnds(offset.part, all(1)), distance = squareRoot(d2);
    // Beyond the ends of round edges contacts fade.
    const Doubles most = along.w < 0 ? (range - distance) / FADE_SLOPE : Doubles{};
    const Doubles beyond = maximum(most, Doubles{}) + 2 * CLOSED;
    const unsigned near = bitsOf((d2 <= range * range) & (over * over * start.w <= beyond * beyond));
    if (near == 0) return 0u;
    const Doubles limit = 2 * CONE_SLACK * distance + 2 * TOUCH;
    __builtin_memcpy(offsets[0], &offset.d.x, sizeof offsets[0]);
    __builtin_memcpy(offsets[1], &offset.d.y, sizeof offsets[1]);
    __builtin_memcpy(offsets[2], &offset.d.z, sizeof offsets[2]);
    return near & bitsOf((dot(batch.inward(edges, OF_SECOND, 0).v, offset.d) <= limit) &
                         (dot(batch.inward(edges, OF_SECOND, 1).v, offset.d) <= limit));
  };
  forEachHit(run, test, [&](std::uint32_t i, int lane) { hits[found++] = {i, {offsets[0][lane], offsets[1][lane], offsets[2][lane]}}; });
  return found;
}

}  // namespace
}  // namespace blem_sim::contact::kernels
