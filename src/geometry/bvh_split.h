// Elements while a tree is built over them, and the split of a run of them in two.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "blem_sim/geometry/types.h"

namespace blem_sim::geometry {

/** Four at once, lane by lane. */
using Floats = float __attribute__((vector_size(16)));

/** Axis-aligned float box; the fourth places are not its own. */
struct BuildBox {
  Floats lower, upper;

  static BuildBox nothing() {
    constexpr float INFINITE = std::numeric_limits<float>::infinity();
    return {Floats{} + INFINITE, Floats{} - INFINITE};
  }
  void extend(const BuildBox& other) {
    lower = other.lower < lower ? other.lower : lower;
    upper = other.upper > upper ? other.upper : upper;
  }
};

/** An element during the build: its box, whose middle (doubled) sorts it, and its index, in the box's fourth places. */
class Primitive {
 public:
  void set(const Vector3& a, const Vector3& b, const Vector3& c, std::uint32_t element) {
    for (int k = 0; k < 3; ++k) {
      box_.lower[k] = roundedDown(std::min({a[k], b[k], c[k]}));
      box_.upper[k] = roundedUp(std::max({a[k], b[k], c[k]}));
    }
    box_.lower[3] = packed(element & MANTISSA);
    box_.upper[3] = packed(element >> MANTISSA_BITS);
  }

  const BuildBox& box() const { return box_; }
  Floats middle() const { return box_.lower + box_.upper; }
  float middle(int axis) const { return box_.lower[axis] + box_.upper[axis]; }
  std::uint32_t element() const { return unpacked(box_.lower[3]) | unpacked(box_.upper[3]) << MANTISSA_BITS; }

 private:
  static constexpr int MANTISSA_BITS = 23;
  static constexpr std::uint32_t MANTISSA = (1u << MANTISSA_BITS) - 1, ONE = 0x3f800000;

  /** A number between 1 and 2: arithmetic with any bits as a float could be slow. */
  static float packed(std::uint32_t mantissa) { return floatOf(ONE | mantissa); }
  static std::uint32_t unpacked(float x) { return bitsOf(x) & MANTISSA; }

  static float floatOf(std::uint32_t bits) {
    float x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
  }
  static std::uint32_t bitsOf(float x) {
    std::uint32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
  }
  /** std::nextafter upwards, without its call. */
  static float next(float x) {
    if (x == 0) return std::numeric_limits<float>::denorm_min();
    return floatOf(x > 0 ? bitsOf(x) + 1 : bitsOf(x) - 1);
  }
  // The sum makes -0.0 positive: of two zeros the order would tell which one a box has.
  static float roundedUp(double x) {
    const float f = static_cast<float>(x);
    return (f < x ? next(f) : f) + 0.0f;
  }
  static float roundedDown(double x) { return 0.0f - roundedUp(-x); }

  BuildBox box_;
};

/** Bounds of a run: of its boxes, and of their doubled middles. */
struct RunBounds {
  BuildBox box = BuildBox::nothing(), middles = box;

  void extend(const Primitive& p) {
    const Floats middle = p.middle();
    box.extend(p.box());
    middles.extend({middle, middle});
  }
  void extend(const RunBounds& other) {
    box.extend(other.box);
    middles.extend(other.middles);
  }
};

/** A run of primitives that becomes a node. */
struct PrimitiveRun {
  Primitive *begin, *end;
  RunBounds bounds;
  std::size_t size() const { return static_cast<std::size_t>(end - begin); }
};

/** The run of all primitives from begin to end; its bounds are found by the threads there are. */
PrimitiveRun boundedRun(Primitive* begin, Primitive* end);

enum class SplitBy { COST, MIDDLE, MEDIAN };

/** Reorders a run of two or more; each side holds something. By COST the surface area heuristic over bins decides [Wald 2007], by MIDDLE
 * the middle of the longest side, which for points costs a third and is as good; or the median where they cannot. */
void splitRun(const PrimitiveRun& run, SplitBy by, PrimitiveRun* left, PrimitiveRun* right);

}  // namespace blem_sim::geometry
