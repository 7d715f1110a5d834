// As many candidates as there are lanes. Included by the kernels only.
#pragma once

#include "lanes.h"

namespace blem_sim::kernels {
namespace {

constexpr unsigned ALL_LANES = (1u << LANES) - 1;

/** Height over the plane, or inside the side. */
inline Doubles above(const Vectors& p, const Rows& plane) { return dot(p, plane.v) - plane.w; }

/** Which candidates the lanes hold: behind the last one it is repeated, and masked. */
struct Batch {
  Batch(const Candidate* candidates, std::uint32_t first, std::uint32_t count) {
    const std::uint32_t left = count - first;
    if (left >= LANES) {
      valid = ALL_LANES;
      take(candidates + first, [](int i) { return i; });
    } else {
      valid = (1u << left) - 1;
      take(candidates + first, [left](int i) { return static_cast<std::uint32_t>(i) < left ? i : left - 1; });
    }
  }

  Rows points(const Vec4* from, const std::uint32_t (&index)[LANES]) const {
    return rows(index, [from](std::uint32_t i) { return &from[i]; });
  }
  template <typename Record>
  Rows field(const Record* from, const std::uint32_t (&index)[LANES], const Vec4 Record::*member) const {
    return rows(index, [=](std::uint32_t i) { return &(from[i].*member); });
  }
  Rows side(const FaceRecord* from, int k) const {
    return rows(of_b, [=](std::uint32_t i) { return &from[i].sides[k]; });
  }
  Rows inward(const EdgeRecord* from, const std::uint32_t (&index)[LANES], int k) const {
    return rows(index, [=](std::uint32_t i) { return &from[i].inward[k]; });
  }

  Mask open(const OpenSides* from) const {
    Mask sides;
    for (int i = 0; i < LANES; ++i) sides[i] = from[of_b[i]];
    return sides;
  }

  std::uint32_t of_a[LANES], of_b[LANES];
  unsigned valid;

 private:
  template <typename Place>
  void take(const Candidate* from, Place&& place) {
    for (int i = 0; i < LANES; ++i) {
      of_a[i] = from[place(i)].a;
      of_b[i] = from[place(i)].b;
    }
  }
  template <typename Address>
  static Rows rows(const std::uint32_t (&index)[LANES], Address&& address) {
    const Vec4* at[LANES];
    for (int i = 0; i < LANES; ++i) at[i] = address(index[i]);
    return gathered(at);
  }
};

}  // namespace
}  // namespace blem_sim::kernels
