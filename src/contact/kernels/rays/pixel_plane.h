// Boxes and triangles in an image, where the camera sees them: conservative. Included by kernels_code.h only.
#pragma once

#include "kernels/rays/fan_kernels.h"
#include "kernels/rays/pixel_rays.h"
#include "kernels/simd.h"

namespace blem_sim::contact::kernels {
namespace {

constexpr double PIXEL_SLACK = 1e-6;  // [pixels] rounding of a place in the image, at most

/** As many floats as there are doubles in a vector. */
typedef float LaneFloats __attribute__((vector_size(4 * LANES)));
inline LaneFloats narrow(Doubles v) { return __builtin_convertvector(v, LaneFloats); }
inline LaneFloats smaller(LaneFloats a, LaneFloats b) { return a < b ? a : b; }

/** Bits of the lanes that are not negative. */
inline unsigned bitsNotNegative(LaneFloats v) {
#if defined(__AVX512F__)
  return ~static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(v))) & 0xFFu;
#elif defined(__AVX2__)
  return ~static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(v))) & 0xFu;
#else
  unsigned bits = 0;
  for (int i = 0; i < LANES; ++i) bits |= static_cast<unsigned>(!(v[i] < 0)) << i;
  return bits;
#endif
}

/** Two numbers side by side, as of two children. */
typedef double Pair __attribute__((vector_size(16)));
inline Pair pairOf(double first, double second) { return Pair{first, second}; }
inline Pair magnitude(Pair a) { return a < 0 ? -a : a; }

/** Whole numbers, both ends included. */
struct Span {
  int first, last;
  int count() const { return last - first + 1; }
};

/** Whole numbers of a span between two places. */
inline Span wholeBetween(double low, double high, const Span& of) {
  // Truncation rounds down what is not negative; a whole number is at least the slack away from the ends.
  low = low > of.first ? low : of.first - 0.5;
  high = high < of.last ? high : of.last + 0.5;
  return {low < of.last + 1 ? static_cast<int>(low - of.first + 1) + of.first : of.last + 1,
          high > of.first - 1 ? static_cast<int>(high - of.first + 1) + of.first - 1 : of.first - 1};
}

/** Pixels of an image. */
struct PixelRange {
  Span columns, rows;
  bool empty() const { return columns.first > columns.last || rows.first > rows.last; }
  int count() const { return columns.count() * rows.count(); }
};

/** A mesh as a pinhole sees it: x right, y down, z ahead [m], and the pixels. */
class PixelPlane {
 public:
  PixelPlane(const PixelRays& rays, const PixelMesh& mesh) : rays_(rays), slack_(mesh.slack) {
    for (int k = 0; k < 3; ++k) {
      double R_CS[3];  // a row of it
      for (int j = 0; j < 3; ++j)
        R_CS[j] = rays.R_CW[3 * k] * rays.R_WS[j] + rays.R_CW[3 * k + 1] * rays.R_WS[3 + j] + rays.R_CW[3 * k + 2] * rays.R_WS[6 + j];
      right_[k] = -R_CS[1];
      down_[k] = -R_CS[2];
      ahead_[k] = R_CS[0];
    }
  }

  /** Boxes of two nodes of a tree. */
  struct Boxes {
    Pair near, far;               ///< [m] ahead
    Pair left, right, up, below;  ///< ends in the image [pixels]; not known if near is not ahead
  };
  Boxes boxesOf(const FanNode& a, const FanNode& b) const {
    Pair middle[3], half[3];
    for (int k = 0; k < 3; ++k) {
      const Pair lower = pairOf(a.lower[k], b.lower[k]), upper = pairOf(a.upper[k], b.upper[k]);
      middle[k] = 0.5 * (lower + upper) - rays_.origin[k];
      half[k] = 0.5 * (upper - lower);
    }
    const Ends x = along(right_, middle, half), y = along(down_, middle, half), z = along(ahead_, middle, half);
    const Pair by_near = rays_.focal_length / z.low, by_far = rays_.focal_length / z.high;
    const auto least = [&](Pair low) { return low * (low > 0 ? by_far : by_near) - PIXEL_SLACK; };
    const auto most = [&](Pair high) { return high * (high > 0 ? by_near : by_far) + PIXEL_SLACK; };
    return {z.low,
            z.high,
            least(x.low) + rays_.middle_u,
            most(x.high) + rays_.middle_u,
            least(y.low) + rays_.middle_v,
            most(y.high) + rays_.middle_v};
  }

  /** Pixels of a range that one of the boxes may cover. */
  PixelRange pixelsOf(const Boxes& boxes, int which, const PixelRange& of) const {
    if (!(boxes.near[which] > 0)) return of;
    return {wholeBetween(boxes.left[which], boxes.right[which], of.columns), wholeBetween(boxes.up[which], boxes.below[which], of.rows)};
  }

  /** A triangle in the image. */
  struct Triangle {
    double near, far;   ///< [m] ahead
    double u[3], v[3];  ///< corners [pixels]; not known if near is not ahead
    double slack;       ///< [pixels] by which they may be off
  };
  /** @param corners seen from the origin, one triangle per lane @param out LANES triangles */
  void trianglesOf(const Vectors (&corners)[3], Triangle* out) const {
    const Projected seen = project(corners);
    const Doubles slack = PIXEL_SLACK + 4 * rays_.focal_length * slack_ / seen.near;
    for (int lane = 0; lane < LANES; ++lane)
      out[lane] = {seen.near[lane],
                   seen.far[lane],
                   {seen.u[0][lane], seen.u[1][lane], seen.u[2][lane]},
                   {seen.v[0][lane], seen.v[1][lane], seen.v[2][lane]},
                   slack[lane]};
  }

  /** Sides of triangles in the image, one triangle per lane: what lies inside has distances of at least 0, and some that lies outside. */
  struct Sides {
    LaneFloats u[3], v[3], rest[3];  ///< a distance is u * column + v * row + rest, counted from the range's first pixel
  };
  void sidesOf(const Vectors (&corners)[3], const PixelRange& range, Sides* out) const {
    const Projected seen = project(corners);
    Doubles u[3], v[3], area = all(0);
    for (int i = 0; i < 3; ++i) {
      u[i] = seen.u[i] - range.columns.first;
      v[i] = seen.v[i] - range.rows.first;
    }
    for (int i = 0; i < 3; ++i) area += u[i] * v[(i + 1) % 3] - u[(i + 1) % 3] * v[i];
    const Mask known = seen.near > FAR_ASIDE * seen.far;
    const Doubles slack = FLOAT_SLACK + 4 * rays_.focal_length * slack_ / seen.near;
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3;
      const Doubles du = u[next] - u[i], dv = v[next] - v[i], turned = area < 0 ? all(-1) : all(1);
      const Doubles rest = dv * u[i] - du * v[i];
      const Doubles wider = slack * (absolute(du) + absolute(dv)) + FLOAT_ROUNDING * absolute(rest);
      out->u[i] = narrow(known ? -turned * dv : all(0));
      out->v[i] = narrow(known ? turned * du : all(0));
      out->rest[i] = narrow(known ? turned * rest + wider : all(1));
    }
  }

  PixelRange pixelsOf(const Triangle& triangle, const PixelRange& of) const {
    if (!(triangle.near > 0)) return of;
    return {wholeBetween(least(triangle.u) - triangle.slack, most(triangle.u) + triangle.slack, of.columns),
            wholeBetween(least(triangle.v) - triangle.slack, most(triangle.v) + triangle.slack, of.rows)};
  }

 private:
  static constexpr double FLOAT_SLACK = 1e-3;     // [pixels] rounding of places within few pixels as floats, at most
  static constexpr double FLOAT_ROUNDING = 1e-6;  // of larger numbers, relative to them
  static constexpr double FAR_ASIDE = 1e-6;       // near over far, below which places in the image are too large for floats

  struct Projected {
    Doubles u[3], v[3];  // [pixels] not known if near is not ahead
    Doubles near, far;   // [m] ahead
  };
  Projected project(const Vectors (&corners)[3]) const {
    Projected seen;
    Doubles ahead[3];
    for (int i = 0; i < 3; ++i) {
      const auto along = [&](const double(&axis)[3]) { return axis[0] * corners[i].x + axis[1] * corners[i].y + axis[2] * corners[i].z; };
      ahead[i] = along(ahead_);
      const Doubles scale = rays_.focal_length / ahead[i];
      seen.u[i] = along(right_) * scale + rays_.middle_u;
      seen.v[i] = along(down_) * scale + rays_.middle_v;
    }
    seen.near = minimum(minimum(ahead[0], ahead[1]), ahead[2]) - slack_;
    seen.far = maximum(maximum(ahead[0], ahead[1]), ahead[2]) + slack_;
    return seen;
  }

  struct Ends {
    Pair low, high;
  };
  Ends along(const double (&axis)[3], const Pair (&middle)[3], const Pair (&half)[3]) const {
    const Pair at = axis[0] * middle[0] + axis[1] * middle[1] + axis[2] * middle[2];
    const Pair reach = magnitude(axis[0] * half[0]) + magnitude(axis[1] * half[1]) + magnitude(axis[2] * half[2]) + slack_;
    return {at - reach, at + reach};
  }
  static double least(const double (&of)[3]) {
    const double low = of[0] < of[1] ? of[0] : of[1];
    return low < of[2] ? low : of[2];
  }
  static double most(const double (&of)[3]) {
    const double high = of[0] > of[1] ? of[0] : of[1];
    return high > of[2] ? high : of[2];
  }

  const PixelRays& rays_;
  const double slack_;
  double right_[3], down_[3], ahead_[3];  // unit, in the mesh's frame
};

/** Columns of a triangle's range in which a row may pass through it. */
class TriangleRows {
 public:
  TriangleRows(const PixelPlane::Triangle& triangle, const PixelRange& range)
      : triangle_(triangle), range_(range), narrow_(range.columns.last - range.columns.first < 4 * TILE || !(triangle.near > 0)) {}

  PixelRange row(int row) const {
    if (narrow_) return {range_.columns, {row, row}};
    double left = __builtin_inf(), right = -__builtin_inf();
    for (int i = 0; i < 3; ++i) addSide(i, (i + 1) % 3, row, &left, &right);
    return {wholeBetween(left - triangle_.slack, right + triangle_.slack, range_.columns), {row, row}};
  }

 private:
  /** Part of a side that lies within the slack of the row. */
  void addSide(int from, int to, int row, double* left, double* right) const {
    const double* const u = triangle_.u;
    const double* const v = triangle_.v;
    const double low = row - triangle_.slack, high = row + triangle_.slack, run = v[to] - v[from];
    if ((v[from] < low && v[to] < low) || (v[from] > high && v[to] > high)) return;
    const auto at = [&](double line) {
      const double part = run != 0 ? (line - v[from]) / run : 0;
      return u[from] + (part < 0 ? 0 : part > 1 ? 1 : part) * (u[to] - u[from]);
    };
    const double ends[4] = {at(low), at(high), v[from] >= low && v[from] <= high ? u[from] : at(low),
                            v[to] >= low && v[to] <= high ? u[to] : at(low)};
    for (const double end : ends) {
      if (end < *left) *left = end;
      if (end > *right) *right = end;
    }
  }

  const PixelPlane::Triangle& triangle_;
  const PixelRange range_;
  const bool narrow_;
};

}  // namespace
}  // namespace blem_sim::contact::kernels
