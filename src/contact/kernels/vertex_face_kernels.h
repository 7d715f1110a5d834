// Vertices near faces, several at once, in double. Included by kernels_code.h only.
#pragma once

#include "kernels/candidate_kernels.h"
#include "kernels/face_sides.h"
#include "kernels/plain_contacts.h"

namespace blem_sim::contact::kernels {
namespace {

std::uint32_t nearVertexFaces(const VerticesAtFaces& features, CandidateRun in, const Reach& reach, Candidate* out, std::uint8_t* inner) {
  const NearVertices& vertices = features.vertices;
  const double range = reach.range + reach.margin, beside = reach.margin + 3 * CLOSED;
  unsigned is_inner = 0;
  const auto test = [&](const Batch& batch) {
    const Vectors p = seenByFaces(vertices, batch.points(vertices.records, OF_FIRST).v);
    return withFaces(batch, features.faces, [&](const auto& faces) {
      const Doubles height = above(p, faces.plane()), most = range - absolute(height);
      const unsigned near = bitsOf(most >= 0);
      if (near == 0) return 0u;
      const InsideSides sides(faces, p);
      is_inner = bitsOf(sides.least() >= NEAR_BORDER + beside);
      return near & bitsOf(isOverOrFades(sides.of, openSides(faces.numbers(features.open), height, reach.margin), most, beside));
    });
  };
  return copied(in, out, test, [&](std::uint32_t at, unsigned bits) {
    for (; bits != 0; bits &= bits - 1) inner[at++] = is_inner >> __builtin_ctz(bits) & 1;
  });
}

/** VertexFaceHit::bits */
inline Mask vertexFaceBits(const InsideSides& sides, Doubles inside, Mask plain) {
  const auto bit = [](Mask is, long value) { return is & value; };
  return bit(sides.of[0] < 0, 1) | bit(sides.of[1] < 0, 2) | bit(sides.of[2] < 0, 4) | bit(plain, VertexFaceHit::PLAIN) |
         bit(inside < -2 * CLOSED, VertexFaceHit::BESIDE) | bit(inside < NEAR_BORDER, VertexFaceHit::NEAR_BORDER);
}

/** Whether a batch is whole and each of its candidates flagged. @param flags null: none is */
inline bool areAll(const std::uint8_t* flags, std::uint32_t first, const Batch& batch) {
  constexpr std::uint8_t ONES[] = {1, 1, 1, 1, 1, 1, 1, 1};
  static_assert(sizeof ONES >= LANES);
  return flags && batch.valid == ALL_LANES && __builtin_memcmp(flags + first, ONES, LANES) == 0;
}

/** Tests vertices over faces, or little beside them. */
class VertexFaceTest {
 public:
  VertexFaceTest(const VerticesAtFaces& features, double range, PlainContacts* plain, VertexFaceHit* hits)
      : vertices_(features.vertices),
        faces_(features.faces),
        open_(features.open),
        range_(range),
        plain_(plain),
        planes_(features.vertices, plain),
        hits_(hits),
        deepest_(all(plain ? plain->deepest : 0)) {}

  /** Appends contacts of vertices that are surely over their faces and not near a border. @return false: one needs a closer look */
  bool appendInner(const Batch& batch) {
    const Rows vertices = batch.points(vertices_.records, OF_FIRST);
    return withFaces(batch, faces_, [&](const auto& faces) {
      const auto& plane = planes_.of(faces);
      const Doubles height = plane.height(vertices.v);
      if (bitsOf(absolute(height) <= TOUCH)) return false;
      const Mask near = range_ - absolute(height) >= 0;
      append(OverFaces{faces, vertices, height}, plane, bitsOf(near), near);
      return true;
    });
  }

  /** Tests any vertices, without branches: hits of lanes are hard to foresee. @param first the batch's first candidate */
  void test(const Batch& batch, std::uint32_t first) {
    withFaces(batch, faces_, [&](const auto& faces) { test(batch, faces, first); });
  }
  template <typename Faces>
  void test(const Batch& batch, const Faces& faces, std::uint32_t first) {
    const Rows vertices = batch.points(vertices_.records, OF_FIRST);
    const auto& plane = planes_.of(faces);
    const OverFaces lanes{faces, vertices, plane.height(vertices.v)};
    const Doubles height = lanes.height, most = range_ - absolute(height);
    const InsideSides sides(faces, seenByFaces(vertices_, vertices.v));
    const Doubles inside = sides.least();
    const Mask touches = absolute(height) <= TOUCH, near = most >= 0, clear = (inside >= NEAR_BORDER) & ~touches & near;
    const unsigned is_clear = plain_ ? append(lanes, plane, bitsOf(clear) & batch.valid, clear) : 0;
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
  /** Appends plain contacts. @param bits of the lanes that have one @param is those lanes, and others perhaps @return the bits */
  template <typename Faces, typename Plane>
  [[gnu::always_inline]] unsigned append(const OverFaces<Faces>& lanes, const Plane& plane, unsigned bits, Mask is) {
    const Doubles depth = appendPlain(lanes, planes_.upInWorld(plane), bits, plain_);
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

std::uint32_t vertexFaces(const VerticesAtFaces& features, const VertexFaceRun& run, double range, PlainContacts* plain,
                          VertexFaceHit* hits) {
  VertexFaceTest test(features, range, plain, hits);
  for (std::uint32_t first = 0; first < run.candidates.count; first += LANES) {
    const Batch batch(run.candidates, first);
    if (plain && areAll(run.inner, first, batch) && test.appendInner(batch)) continue;
    test.test(batch, first);
  }
  return test.finish();
}

}  // namespace
}  // namespace blem_sim::contact::kernels
