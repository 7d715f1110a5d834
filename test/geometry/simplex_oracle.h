// Closest points of two triangles by plain enumeration, independent of the library's formulas: the oracle of the tests.
#pragma once

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "blem_sim/geometry/closest_points.h"

namespace blem_sim::geometry {

/**
 * Smallest distance of two simplices given by their corners (1 to 3 each), in long double. The minimum of a convex quadratic over a
 * product of simplices is the least-squares solution over the affine hulls of some pair of faces; every pair is solved by QR and kept
 * where its weights are not negative. Pairs whose system is rank deficient have their minimum in a smaller face too, so may be wrong here.
 */
inline double simplexDistance(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  using Real = long double;
  using Point = Eigen::Matrix<Real, 3, 1>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, 3, 1>;
  using Matrix = Eigen::Matrix<Real, 3, Eigen::Dynamic, 0, 3, 3>;
  // The corners of a simplex whose bits are set in `face`: the first, then the differences of the others from it.
  struct Face {
    Face(const std::vector<Vector3>& corners, unsigned face) {
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if (!(face & (1u << i))) continue;
        if (++size == 1) {
          first = corners[i].cast<Real>();
        } else {
          spans.col(size - 2) = corners[i].cast<Real>() - first;
        }
      }
    }
    int size = 0;
    Point first;
    Eigen::Matrix<Real, 3, 2> spans;
  };
  Real best = std::numeric_limits<Real>::infinity();
  for (unsigned face_a = 1; face_a < (1u << a.size()); ++face_a) {
    for (unsigned face_b = 1; face_b < (1u << b.size()); ++face_b) {
      const Face fa(a, face_a), fb(b, face_b);
      const int m = fa.size - 1, n = fb.size - 1;
      const Point offset = fa.first - fb.first;
      if (m + n == 0) best = std::min(best, offset.norm());
      if (m + n == 0 || m + n > 3) continue;
      // fa.first + A s - fb.first - B t, least squares in (s, t).
      Matrix system(3, m + n);
      system << fa.spans.leftCols(m), -fb.spans.leftCols(n);
      const Eigen::ColPivHouseholderQR<Matrix> qr(system);
      if (qr.rank() < m + n) continue;
      const Vector x = qr.solve(-offset);
      if ((x.array() < 0).any() || x.head(m).sum() > 1 || x.tail(n).sum() > 1) continue;
      best = std::min(best, (offset + system * x).norm());
    }
  }
  return static_cast<double>(best);
}

inline double oracleDistance(const Triangle& a, const Triangle& b) {
  return simplexDistance(std::vector<Vector3>(a.begin(), a.end()), std::vector<Vector3>(b.begin(), b.end()));
}

inline double oracleDistance(const Vector3& p, const Triangle& t) { return simplexDistance({p}, std::vector<Vector3>(t.begin(), t.end())); }

}  // namespace blem_sim::geometry
