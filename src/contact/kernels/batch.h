// Batches of as many candidates as there are lanes. Included by the kernels only.
#pragma once

#include "kernels/simd.h"

namespace blem_sim::contact::kernels {
namespace {

constexpr unsigned ALL_LANES = (1u << LANES) - 1;

/** Height over the plane, or inside the side. */
inline Doubles above(const Vectors& p, const Rows& plane) { return dot(p, plane.v) - plane.w; }

/** One of a candidate's two features. */
using Which = std::uint32_t Candidate::*;
constexpr Which OF_FIRST = &Candidate::first, OF_SECOND = &Candidate::second;

/** Candidates in the lanes: behind the last one it is repeated, and masked. */
class Batch {
 public:
  Batch(CandidateRun run, std::uint32_t first) : lanes(run.data + first), valid(ALL_LANES) {
    const std::uint32_t left = run.count - first;
    if (left >= LANES) return;
    for (std::uint32_t i = 0; i < LANES; ++i) padded_[i] = lanes[i < left ? i : left - 1];
    lanes = padded_;
    valid = (1u << left) - 1;
  }
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  Rows points(const Vec4* from, Which of) const {
    return rows(of, [from](std::uint32_t i) { return &from[i]; });
  }
  template <typename Record>
  Rows field(const Record* from, Which of, const Vec4 Record::*member) const {
    return rows(of, [=](std::uint32_t i) { return &(from[i].*member); });
  }
  Rows side(const FaceRecord* from, int k) const {
    return rows(OF_SECOND, [=](std::uint32_t i) { return &from[i].sides[k]; });
  }
  Rows inward(const EdgeRecord* from, Which of, int k) const {
    return rows(of, [=](std::uint32_t i) { return &from[i].inward[k]; });
  }
  Mask numbers(const std::int32_t* from, Which of) const {
    Mask numbers;
    for (int i = 0; i < LANES; ++i) numbers[i] = from[lanes[i].*of];
    return numbers;
  }

  /** Whether all lanes have the same second feature. */
  bool hasOneSecond() const {
    static_assert(sizeof(Candidate) == sizeof(Mask) / LANES, "a candidate is as wide as a lane");
    constexpr Candidate ONLY_SECOND{0, 0xFFFFFFFF};
    Mask pairs;
    long first, only_second;
    __builtin_memcpy(&pairs, lanes, sizeof pairs);
    __builtin_memcpy(&first, lanes, sizeof first);
    __builtin_memcpy(&only_second, &ONLY_SECOND, sizeof only_second);
    return bitsOf(((pairs ^ first) & only_second) != 0) == 0;
  }

  const Candidate* lanes;
  unsigned valid;

 private:
  template <typename Address>
  Rows rows(Which of, Address&& address) const {
    const Vec4* at[LANES];
    for (int i = 0; i < LANES; ++i) at[i] = address(lanes[i].*of);
    return gathered(at);
  }

  Candidate padded_[LANES];
};

/** The lanes' second features, each its own. */
struct EachFace {
  Rows plane() const { return batch.field(faces, OF_SECOND, &FaceRecord::plane); }
  Rows side(int k) const { return batch.side(faces, k); }
  Mask numbers(const std::int32_t* from) const { return batch.numbers(from, OF_SECOND); }

  const Batch& batch;
  const FaceRecord* faces;
};

/** One face in all lanes. */
struct OneFace {
  Rows plane() const { return everywhere(face.plane); }
  Rows side(int k) const { return everywhere(face.sides[k]); }
  Mask numbers(const std::int32_t* from) const { return from[index] - Mask{}; }

  const FaceRecord& face;
  std::uint32_t index;
};

/** Calls visit with the lanes' faces. @return visit's result */
template <typename Visit>
inline auto withFaces(const Batch& batch, const FaceRecord* faces, Visit&& visit) {
  const std::uint32_t first = batch.lanes[0].second;
  return batch.hasOneSecond() ? visit(OneFace{faces[first], first}) : visit(EachFace{batch, faces});
}

}  // namespace
}  // namespace blem_sim::contact::kernels
