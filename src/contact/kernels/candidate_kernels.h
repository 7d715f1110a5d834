// Candidates, several at once, in double. Included by kernels_code.h only.
#pragma once

#include "../tolerances.h"
#include "batch.h"
#include "edge_cones.h"
#include "edge_sides.h"
#include "face_sides.h"
#include "lanes.h"
#include "plain_contacts.h"

namespace blem_sim::kernels {
namespace {

/** Calls test(batch) for all; where its bits are set, take(candidate's index, lane). */
template <typename Test, typename Take>
inline void forEachHit(const Candidate* candidates, std::uint32_t count, Test&& test, Take&& take) {
  for (std::uint32_t first = 0; first < count; first += LANES) {
    const Batch batch(candidates, first, count);
    for (unsigned bits = test(batch) & batch.valid; bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      take(first + lane, lane);
    }
  }
}

template <typename Test>
inline std::uint32_t listed(const Candidate* candidates, std::uint32_t count, std::uint32_t* hits, Test&& test) {
  std::uint32_t found = 0;
  forEachHit(candidates, count, test, [&](std::uint32_t i, int) { hits[found++] = i; });
  return found;
}

struct InsideSides {
  template <typename Faces>
  InsideSides(const Faces& faces, const Vectors& p) : of{above(p, faces.side(0)), above(p, faces.side(1)), above(p, faces.side(2))} {}
  Doubles least() const { return minimum(minimum(of[0], of[1]), of[2]); }

  const Doubles of[3];
};

// ---- what can have a contact soon: as for leaves, in double

/** Copies those for which test(batch) sets bits. @param also is called with the first lane's place among them and its bits, before all of
 * them */
template <typename Test, typename Also>
inline std::uint32_t copied(const Candidate* in, std::uint32_t count, Candidate* out, Test&& test, Also&& also) {
  std::uint32_t kept = 0;
  for (std::uint32_t first = 0; first < count; first += LANES) {
    const Batch batch(in, first, count);
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
inline std::uint32_t copied(const Candidate* in, std::uint32_t count, Candidate* out, Test&& test) {
  return copied(in, count, out, test, [](std::uint32_t, unsigned) {});
}

std::uint32_t nearVertexFaces(const NearVertices& a, const FaceRecord* b, const OpenSides* open, const Candidate* in, std::uint32_t count,
                              const Reach& reach, Candidate* out, std::uint8_t* inner) {
  const double range = reach.range + reach.margin, beside = reach.margin + 3 * CLOSED;
  unsigned is_inner = 0;
  const auto test = [&](const Batch& batch) {
    const Vectors p = seenByFaces(a, batch.points(a.records, OF_A).v);
    return withFaces(batch, b, [&](const auto& faces) {
      const Doubles height = above(p, faces.plane()), most = range - absolute(height);
      const unsigned near = bitsOf(most >= 0);
      if (near == 0) return 0u;
      const InsideSides sides(faces, p);
      is_inner = bitsOf(sides.least() >= NEAR_BORDER + beside);
      return near & bitsOf(isOverOrFades(sides.of, openSides(faces.numbers(open), height, reach.margin), most, beside));
    });
  };
  return copied(in, count, out, test, [&](std::uint32_t at, unsigned bits) {
    for (; bits != 0; bits &= bits - 1) inner[at++] = is_inner >> __builtin_ctz(bits) & 1;
  });
}

/** Are both ends of an edge, seen from the start of another, farther than the limit inside a face of that one? */
inline Mask liesInside(const Vectors& first, const Vectors& second, const Vectors& inward, double limit) {
  return minimum(dot(inward, first), dot(inward, second)) > limit;
}

std::uint32_t nearEdgeEdges(const EdgeRecord* a, const EdgeRecord* b, const Candidate* in, std::uint32_t count, const Reach& reach,
                            Candidate* out) {
  const double range = reach.range + reach.margin, limit = deepestInside(range) + reach.margin;
  return copied(in, count, out, [&](const Batch& batch) {
    const Rows start_a = batch.field(a, OF_A, &EdgeRecord::start), start_b = batch.field(b, OF_B, &EdgeRecord::start);
    const Vectors p = batch.field(a, OF_A, &EdgeRecord::along).v, q = batch.field(b, OF_B, &EdgeRecord::along).v;
    const Vectors r = start_b.v - start_a.v, back = start_a.v - start_b.v;
    Mask inside{};
    for (int k = 0; k < 2; ++k) {
      inside |= liesInside(r, r + q, batch.inward(a, OF_A, k).v, limit);
      inside |= liesInside(back, back + p, batch.inward(b, OF_B, k).v, limit);
    }
    const unsigned crosswise = ~bitsOf(inside) & ALL_LANES;
    if (crosswise == 0) return 0u;
    const Doubles pp = start_a.w, qq = start_b.w, pq = dot(p, q), pr = dot(p, r), qr = dot(q, r), denominator = pp * qq - pq * pq;
    const Doubles first = denominator > 0 ? clampedToUnit((pr * qq - pq * qr) / denominator) : Doubles{};
    const Doubles t = clampedToUnit((pq * first - qr) / qq), s = clampedToUnit((pq * t + pr) / pp);
    const Vectors d = r + t * q - s * p;
    const unsigned near = crosswise & ~bitsOf(dot(d, d) > range * range);
    if (near == 0) return 0u;
    const Vectors n = cross(p, q);
    return near & bitsOf(conesMayAllow(n, coneBound(dot(n, n), pp * qq, reach.turn), batch.inward(a, OF_A, 0).v, batch.inward(a, OF_A, 1).v,
                                       batch.inward(b, OF_B, 0).v, batch.inward(b, OF_B, 1).v));
  });
}

std::uint32_t nearVertexEdges(const Vec4* a, const EdgeRecord* b, const Candidate* in, std::uint32_t count, const Reach& reach,
                              Candidate* out) {
  const double range = reach.range + reach.margin, margin = reach.margin + 3 * CLOSED, limit = 2 * CONE_SLACK * range + margin;
  return copied(in, count, out, [&](const Batch& batch) {
    const Rows start = batch.field(b, OF_B, &EdgeRecord::start);
    const Vectors r = batch.points(a, OF_A).v - start.v;
    const Vectors u = batch.inward(b, OF_B, 0).v, v = batch.inward(b, OF_B, 1).v, both = u + v;
    const Doubles inside = dot(u, r), also = dot(v, r);
    const unsigned beside = bitsOf(maximum(inside, also) <= limit);
    if (beside == 0) return 0u;
    const Rows along = batch.field(b, OF_B, &EdgeRecord::along);
    const Doubles part = dot(r, along.v) / start.w, length = squareRoot(start.w);
    const Vectors d = r - part * along.v;
    const AtEdge<Doubles> vertex{{inside, also}, squareRoot(dot(d, d)), maximum(-part, part - 1) * length};
    return beside & bitsOf(isAtEdge(vertex, squareRoot(dot(both, both)), along.w < 0, range, margin, 3 * CLOSED));
  });
}

std::uint32_t nearVertexVertices(const Vec4* a, const Vec4* b, const Candidate* in, std::uint32_t count, const Reach& reach,
                                 Candidate* out) {
  const double range = reach.range + reach.margin;
  return copied(in, count, out, [&](const Batch& batch) {
    const Vectors d = batch.points(a, OF_A).v - batch.points(b, OF_B).v;
    return bitsOf(dot(d, d) <= range * range);
  });
}

// ---- what has a contact

/** VertexFaceHit::bits */
inline Mask vertexFaceBits(const InsideSides& sides, Doubles inside, Mask plain) {
  const auto bit = [](Mask is, long value) { return is & value; };
  return bit(sides.of[0] < 0, 1) | bit(sides.of[1] < 0, 2) | bit(sides.of[2] < 0, 4) | bit(plain, VertexFaceHit::PLAIN) |
         bit(inside < -2 * CLOSED, VertexFaceHit::BESIDE) | bit(inside < NEAR_BORDER, VertexFaceHit::NEAR_BORDER);
}

/** Is a batch whole and each of its candidates flagged? @param flags null: none is */
inline bool areAll(const std::uint8_t* flags, std::uint32_t first, const Batch& batch) {
  constexpr std::uint8_t ONES[] = {1, 1, 1, 1, 1, 1, 1, 1};
  static_assert(sizeof ONES >= LANES);
  return flags && batch.valid == ALL_LANES && __builtin_memcmp(flags + first, ONES, LANES) == 0;
}

/** Tests vertices over faces, or little beside them. */
class VertexFaceTest {
 public:
  VertexFaceTest(const NearVertices& vertices, const FaceRecord* faces, const OpenSides* open, double range, PlainContacts* plain,
                 VertexFaceHit* hits)
      : vertices_(vertices),
        faces_(faces),
        open_(open),
        range_(range),
        plain_(plain),
        planes_(vertices, plain),
        hits_(hits),
        deepest_(all(plain ? plain->deepest : 0)) {}

  /** Of vertices that are surely over their faces and not near a border. @return false: there is one that needs a closer look */
  bool appendInner(const Batch& batch) {
    const Rows vertices = batch.points(vertices_.records, OF_A);
    return withFaces(batch, faces_, [&](const auto& faces) {
      const auto& plane = planes_.of(faces);
      const Doubles height = plane.height(vertices.v);
      if (bitsOf(absolute(height) <= TOUCH)) return false;
      append(batch, faces, vertices, plane, height, range_ - absolute(height) >= 0);
      return true;
    });
  }

  /** Of any. Which lanes have what is hard to foresee: it does not branch. @param first the batch's first candidate */
  void test(const Batch& batch, std::uint32_t first) {
    withFaces(batch, faces_, [&](const auto& faces) { test(batch, faces, first); });
  }
  template <typename Faces>
  void test(const Batch& batch, const Faces& faces, std::uint32_t first) {
    const Rows vertices = batch.points(vertices_.records, OF_A);
    const auto& plane = planes_.of(faces);
    const Doubles height = plane.height(vertices.v), most = range_ - absolute(height);
    const InsideSides sides(faces, seenByFaces(vertices_, vertices.v));
    const Doubles inside = sides.least();
    const Mask touches = absolute(height) <= TOUCH, near = most >= 0, clear = (inside >= NEAR_BORDER) & ~touches & near;
    const unsigned is_clear = plain_ ? append(batch, faces, vertices, plane, height, clear) : 0;
    const Mask over = isOverOrFades(sides.of, openSides(faces.numbers(open_), height, 0.0), most, 2 * CLOSED);
    const Mask bits = vertexFaceBits(sides, inside, (inside >= 0) & ~touches);
    const unsigned is_hit = bitsOf(over & near) & batch.valid & ~is_clear;
    // Every lane writes, the next one over it if it has none.
    VertexFaceHit* hit = hits_ + found_;
    for (int i = 0; i < LANES; ++i) {
      *hit = {first + i, static_cast<std::uint32_t>(bits[i]), height[i]};
      hit += is_hit >> i & 1;
    }
    found_ = static_cast<std::uint32_t>(hit - hits_);
  }

  /** @return number of hits */
  std::uint32_t finish() {
    raiseDeepest(deepest_, plain_);
    return found_;
  }

 private:
  /** Plain contacts of the lanes where there is one. @return their bits */
  template <typename Faces, typename Plane>
  [[gnu::always_inline]] unsigned append(const Batch& batch, const Faces& faces, const Rows& vertices, const Plane& plane, Doubles height,
                                         Mask is) {
    const unsigned bits = bitsOf(is) & batch.valid;
    const Doubles depth = appendPlain(faces, vertices, planes_.upInWorld(plane), height, bits, plain_);
    deepest_ = maximum(deepest_, is ? depth : deepest_);
    return bits;
  }

  const NearVertices& vertices_;
  const FaceRecord* const faces_;
  const OpenSides* const open_;
  const double range_;
  PlainContacts* const plain_;
  FacePlanes planes_;
  VertexFaceHit* const hits_;
  std::uint32_t found_ = 0;
  Doubles deepest_;
};

std::uint32_t vertexFaces(const NearVertices& a, const FaceRecord* b, const OpenSides* open, const Candidate* candidates,
                          std::uint32_t count, const std::uint8_t* inner, double range, PlainContacts* plain, VertexFaceHit* hits) {
  VertexFaceTest test(a, b, open, range, plain, hits);
  for (std::uint32_t first = 0; first < count; first += LANES) {
    const Batch batch(candidates, first, count);
    if (plain && areAll(inner, first, batch) && test.appendInner(batch)) continue;
    test.test(batch, first);
  }
  return test.finish();
}

/** How far a part of an edge times n2 lies beyond its ends. */
inline Doubles beyondEnds(Doubles part, Doubles n2) { return maximum(maximum(-part, part - n2), Doubles{}); }

std::uint32_t vertexVertices(const Vec4* a, const Vec4* b, const Candidate* candidates, std::uint32_t count, double range,
                             std::uint32_t* hits) {
  return listed(candidates, count, hits, [&](const Batch& batch) {
    const Vectors d = batch.points(a, OF_A).v - batch.points(b, OF_B).v;
    return bitsOf(dot(d, d) <= range * range);
  });
}

std::uint32_t edgeFaces(const EdgeRecord* a, const FaceRecord* b, const Candidate* candidates, std::uint32_t count, std::uint32_t* hits) {
  return listed(candidates, count, hits, [&](const Batch& batch) {
    const Vectors start = batch.field(a, OF_A, &EdgeRecord::start).v, along = batch.field(a, OF_A, &EdgeRecord::along).v;
    return withFaces(batch, b, [&](const auto& faces) {
      const Rows plane = faces.plane();
      const Doubles first = above(start, plane), second = above(start + along, plane);
      const unsigned through = bitsOf((minimum(first, second) < -TOUCH) & (maximum(first, second) > TOUCH));
      if (through == 0) return 0u;
      return through & bitsOf(InsideSides(faces, start + first / (first - second) * along).least() >= -2 * CLOSED);
    });
  });
}

}  // namespace
}  // namespace blem_sim::kernels
