// Closest points of two triangles by plain enumeration, independent of the library's formulas: the oracle of the tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "blem_sim/geometry/closest_points.h"

namespace blem_sim::geometry {

using Real = long double;
using RealPoint = Eigen::Matrix<Real, 3, 1>;

/** Weights x of at most three columns that bring their sum nearest to a point, by Gram and Schmidt; not where the columns depend on each
 *  other. Plain loops, for Eigen's decompositions of long doubles take a compiler some ten seconds. */
inline bool leastSquares(const std::vector<RealPoint>& columns, RealPoint point, std::array<Real, 3>* x) {
  std::array<RealPoint, 3> axes;
  std::array<std::array<Real, 3>, 3> r;
  const std::size_t count = columns.size();
  for (std::size_t j = 0; j < count; ++j) {
    axes[j] = columns[j];
    for (std::size_t i = 0; i < j; ++i) {
      r[i][j] = axes[i].dot(axes[j]);
      axes[j] -= r[i][j] * axes[i];
    }
    r[j][j] = axes[j].norm();
    if (r[j][j] <= 1e-18L * columns[j].norm()) return false;
    axes[j] /= r[j][j];
  }
  for (std::size_t j = 0; j < count; ++j) {
    (*x)[j] = axes[j].dot(point);
    point -= (*x)[j] * axes[j];
  }
  for (std::size_t j = count; j-- > 0;) {
    for (std::size_t k = j + 1; k < count; ++k) (*x)[j] -= r[j][k] * (*x)[k];
    (*x)[j] /= r[j][j];
  }
  return true;
}

/**
 * Smallest distance of two simplices given by their corners (1 to 3 each), in long double. The minimum of a convex quadratic over a
 * product of simplices is the least-squares solution over the affine hulls of some pair of faces; every pair is solved and kept
 * where its weights are not negative. Pairs whose system is rank deficient have their minimum in a smaller face too, so may be wrong here.
 */
inline double simplexDistance(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  // The corners of a simplex whose bits are set in `face`: the first, then the differences of the others from it.
  struct Face {
    Face(const std::vector<Vector3>& corners, unsigned face) {
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if (!(face & (1u << i))) continue;
        if (++size == 1) {
          first = corners[i].cast<Real>();
        } else {
          spans.push_back(corners[i].cast<Real>() - first);
        }
      }
    }
    int size = 0;
    RealPoint first;
    std::vector<RealPoint> spans;
  };
  Real best = std::numeric_limits<Real>::infinity();
  for (unsigned face_a = 1; face_a < (1u << a.size()); ++face_a) {
    for (unsigned face_b = 1; face_b < (1u << b.size()); ++face_b) {
      const Face fa(a, face_a), fb(b, face_b);
      const std::size_t m = fa.spans.size(), n = fb.spans.size();
      if (m + n > 3) continue;
      // fa.first + A s - fb.first - B t, least squares in (s, t).
      std::vector<RealPoint> columns = fa.spans;
      for (const RealPoint& span : fb.spans) columns.push_back(-span);
      std::array<Real, 3> x;
      const RealPoint offset = fa.first - fb.first;
      if (!leastSquares(columns, -offset, &x)) continue;
      const auto begin = x.cbegin(), split = begin + m, end = split + n;
      if (std::any_of(begin, end, [](Real weight) { return weight < 0; })) continue;
      if (std::accumulate(begin, split, Real{0}) > 1 || std::accumulate(split, end, Real{0}) > 1) continue;
      RealPoint apart = offset;
      for (std::size_t i = 0; i < m + n; ++i) apart += x[i] * columns[i];
      best = std::min(best, apart.norm());
    }
  }
  return static_cast<double>(best);
}

inline double oracleDistance(const Triangle& a, const Triangle& b) {
  return simplexDistance(std::vector<Vector3>(a.begin(), a.end()), std::vector<Vector3>(b.begin(), b.end()));
}

inline double oracleDistance(const Vector3& p, const Triangle& t) { return simplexDistance({p}, std::vector<Vector3>(t.begin(), t.end())); }

}  // namespace blem_sim::geometry
