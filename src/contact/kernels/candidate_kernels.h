// Candidates, several at once, in double. Included by kernels_code.h only.
#pragma once

#include "features/tolerances.h"
#include "kernels/batch.h"
#include "kernels/edge_cones.h"
#include "kernels/edge_sides.h"
#include "kernels/simd.h"

namespace blem_sim::contact::kernels {
namespace {

/** Calls test(batch) for all; where its bits are set, take(candidate's index, lane). */
template <typename Test, typename Take>
inline void forEachHit(CandidateRun run, Test&& test, Take&& take) {
  for (std::uint32_t first = 0; first < run.count; first += LANES) {
    const Batch batch(run, first);
    for (unsigned bits = test(batch) & batch.valid; bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      take(first + lane, lane);
    }
  }
}

template <typename Test>
inline std::uint32_t listed(CandidateRun run, std::uint32_t* hits, Test&& test) {
  std::uint32_t found = 0;
  forEachHit(run, test, [&](std::uint32_t i, int) { hits[found++] = i; });
  return found;
}

struct InsideSides {
  template <typename Faces>
  InsideSides(const Faces& faces, const Vectors& p) : of{above(p, faces.side(0)), above(p, faces.side(1)), above(p, faces.side(2))} {}
  Doubles least() const { return minimum(minimum(of[0], of[1]), of[2]); }

  const Doubles of[3];
};

// ---- candidates that can have a contact soon: as for leaves, in double

/** Copies the candidates for which test(batch) sets bits. @param also is called with the first lane's place among them and its bits, before
 * all of them */
template <typename Test, typename Also>
inline std::uint32_t copied(CandidateRun in, Candidate* out, Test&& test, Also&& also) {
  std::uint32_t kept = 0;
  for (std::uint32_t first = 0; first < in.count; first += LANES) {
    const Batch batch(in, first);
    const unsigned bits = test(batch) & batch.valid;
    also(kept, bits);
    if (bits == ALL_LANES) {
      __builtin_memcpy(out + kept, batch.lanes, LANES * sizeof(Candidate));
      kept += LANES;
      continue;
    }
    for (unsigned left = bits; left != 0; left &= left - 1) out[kept++] = batch.lanes[__builtin_ctz(left)];
  }
  return kept;
}
template <typename Test>
inline std::uint32_t copied(CandidateRun in, Candidate* out, Test&& test) {
  return copied(in, out, test, [](std::uint32_t, unsigned) {});
}

/** Whether both ends of an edge, seen from the start of another, are farther than the limit inside a face of that one. */
inline Mask liesInside(const Vectors& first, const Vectors& second, const Vectors& inward, double limit) {
  return minimum(dot(inward, first), dot(inward, second)) > limit;
}

std::uint32_t nearEdgeEdges(const EdgeRecord* moving, const EdgeRecord* fixed, CandidateRun in, const Reach& reach, Candidate* out) {
  const double range = reach.range + reach.margin, limit = deepestInside(range) + reach.margin;
  return copied(in, out, [&](const Batch& batch) {
    const Rows start_m = batch.field(moving, OF_FIRST, &EdgeRecord::start), start_f = batch.field(fixed, OF_SECOND, &EdgeRecord::start);
    const Vectors p = batch.field(moving, OF_FIRST, &EdgeRecord::along).v, q = batch.field(fixed, OF_SECOND, &EdgeRecord::along).v;
    const Vectors r = start_f.v - start_m.v, back = start_m.v - start_f.v;
    Mask inside{};
    for (int k = 0; k < 2; ++k) {
      inside |= liesInside(r, r + q, batch.inward(moving, OF_FIRST, k).v, limit);
      inside |= liesInside(back, back + p, batch.inward(fixed, OF_SECOND, k).v, limit);
    }
    const unsigned crosswise = ~bitsOf(inside) & ALL_LANES;
    if (crosswise == 0) return 0u;
    const Doubles pp = start_m.w, qq = start_f.w, pq = dot(p, q), pr = dot(p, r), qr = dot(q, r), denominator = pp * qq - pq * pq;
    const Doubles first = denominator > 0 ? clampedToUnit((pr * qq - pq * qr) / denominator) : Doubles{};
    const Doubles t = clampedToUnit((pq * first - qr) / qq), s = clampedToUnit((pq * t + pr) / pp);
    const Vectors d = r + t * q - s * p;
    const unsigned near = crosswise & ~bitsOf(dot(d, d) > range * range);
    if (near == 0) return 0u;
    const Vectors n = cross(p, q), into_m[] = {batch.inward(moving, OF_FIRST, 0).v, batch.inward(moving, OF_FIRST, 1).v},
                  into_f[] = {batch.inward(fixed, OF_SECOND, 0).v, batch.inward(fixed, OF_SECOND, 1).v};
    return near & bitsOf(conesMayAllow(n, coneBound(dot(n, n), pp * qq, reach.turn), into_m, into_f));
  });
}

std::uint32_t nearVertexEdges(const Vec4* vertices, const EdgeRecord* edges, CandidateRun in, const Reach& reach, Candidate* out) {
  const double range = reach.range + reach.margin, margin = reach.margin + 3 * CLOSED, limit = 2 * CONE_SLACK * range + margin;
  return copied(in, out, [&](const Batch& batch) {
    const Rows start = batch.field(edges, OF_SECOND, &EdgeRecord::start);
    const Vectors r = batch.points(vertices, OF_FIRST).v - start.v;
    const Vectors u = batch.inward(edges, OF_SECOND, 0).v, v = batch.inward(edges, OF_SECOND, 1).v, both = u + v;
    const Doubles inside = dot(u, r), also = dot(v, r);
    const unsigned beside = bitsOf(maximum(inside, also) <= limit);
    if (beside == 0) return 0u;
    const Rows along = batch.field(edges, OF_SECOND, &EdgeRecord::along);
    const Doubles part = dot(r, along.v) / start.w, length = squareRoot(start.w);
    const Vectors d = r - part * along.v;
    const AtEdge<Doubles> vertex{{inside, also}, squareRoot(dot(d, d)), maximum(-part, part - 1) * length};
    return beside & bitsOf(isAtEdge(vertex, squareRoot(dot(both, both)), along.w < 0, EdgeReach<double>{range, margin, 3 * CLOSED}));
  });
}

std::uint32_t nearVertexVertices(const Vec4* moving, const Vec4* fixed, CandidateRun in, const Reach& reach, Candidate* out) {
  const double range = reach.range + reach.margin;
  return copied(in, out, [&](const Batch& batch) {
    const Vectors d = batch.points(moving, OF_FIRST).v - batch.points(fixed, OF_SECOND).v;
    return bitsOf(dot(d, d) <= range * range);
  });
}

// ---- candidates that have a contact

/** Excess of a part of an edge, times n2, beyond the edge's ends; 0 inside. */
inline Doubles beyondEnds(Doubles part, Doubles n2) { return maximum(maximum(-part, part - n2), Doubles{}); }

std::uint32_t vertexVertices(const Vec4* moving, const Vec4* fixed, CandidateRun run, double range, std::uint32_t* hits) {
  return listed(run, hits, [&](const Batch& batch) {
    const Vectors d = batch.points(moving, OF_FIRST).v - batch.points(fixed, OF_SECOND).v;
    return bitsOf(dot(d, d) <= range * range);
  });
}

std::uint32_t edgeFaces(const EdgeRecord* edges, const FaceRecord* faces, CandidateRun run, std::uint32_t* hits) {
  return listed(run, hits, [&](const Batch& batch) {
    const Vectors start = batch.field(edges, OF_FIRST, &EdgeRecord::start).v, along = batch.field(edges, OF_FIRST, &EdgeRecord::along).v;
    return withFaces(batch, faces, [&](const auto& here) {
      const Rows plane = here.plane();
      const Doubles first = above(start, plane), second = above(start + along, plane);
      const unsigned through = bitsOf((minimum(first, second) < -TOUCH) & (maximum(first, second) > TOUCH));
      if (through == 0) return 0u;
      return through & bitsOf(InsideSides(here, start + first / (first - second) * along).least() >= -2 * CLOSED);
    });
  });
}

}  // namespace
}  // namespace blem_sim::contact::kernels
