#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "blem_sim/geometry/triangle_mesh.h"

namespace blem_sim::geometry {
namespace {

/** Sums simplices of uniform density (points, segments, triangles, tetrahedra) up to the moment of order two. */
class MomentSum {
 public:
  explicit MomentSum(const Vector3& origin) : origin_(origin) {}

  /** @param measure length, area or signed volume @param corners N corners of the simplex */
  template <int N>
  void add(double measure, const Vector3 (&corners)[N]) {
    Vector3 sum = Vector3::Zero();
    Matrix3 squares = Matrix3::Zero();
    for (const Vector3& corner : corners) {
      const Vector3 r = corner - origin_;
      sum += r;
      squares += r * r.transpose();
    }
    measure_ += measure;
    first_ += measure / N * sum;
    second_ += measure / (N * (N + 1)) * (squares + sum * sum.transpose());
  }

  double measure() const { return measure_; }

  /** The sum scaled to the given mass. Precondition: measure() != 0. */
  MassProperties properties(double mass) const {
    const Vector3 r = first_ / measure_;
    const Matrix3 covariance = mass * (second_ / measure_ - r * r.transpose());
    MassProperties result;
    result.mass = mass;
    result.com = origin_ + r;
    result.inertia = covariance.trace() * Matrix3::Identity() - covariance;
    return result;
  }

 private:
  Vector3 origin_;
  double measure_ = 0;
  Vector3 first_ = Vector3::Zero();
  Matrix3 second_ = Matrix3::Zero();
};

double area(const Vector3& a, const Vector3& b, const Vector3& c) { return 0.5 * (b - a).cross(c - a).norm(); }

/** Whether each edge runs as often one way as the other: then the triangles enclose a volume, and all turn their outside out, or all in. */
bool isClosedAndConsistentlyWound(const TriangleMesh& mesh) {
  struct DirectedEdge {
    int low, high, direction;
    bool operator<(const DirectedEdge& other) const { return std::make_pair(low, high) < std::make_pair(other.low, other.high); }
  };
  std::vector<DirectedEdge> edges;
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
    if (!mesh.isTriangle(i)) continue;
    const Vector3i& e = mesh.elements[i];
    for (int k = 0; k < 3; ++k) {
      const int p = e[k], q = e[(k + 1) % 3];
      edges.push_back({std::min(p, q), std::max(p, q), p < q ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    const std::size_t begin = i;
    int balance = 0;
    for (; i < edges.size() && !(edges[begin] < edges[i]); ++i) balance += edges[i].direction;
    if (balance != 0) return false;
  }
  return !edges.empty();
}

/** Whether an inertia is positive definite and no axis heavier than the other two together, as of a body with mass everywhere. */
bool isInertiaOfVolume(const Matrix3& inertia) {
  const Vector3 moments = Eigen::SelfAdjointEigenSolver<Matrix3>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  return moments[0] > 0 && moments[0] + moments[1] > moments[2];
}

}  // namespace

bool massFromVolume(const TriangleMesh& mesh, double mass, MassProperties* out) {
  if (!isClosedAndConsistentlyWound(mesh)) return false;
  const Box box = mesh.bounds();
  // Tetrahedra from the middle of the box: from a far origin they would cancel.
  const Vector3 apex = box.center();
  MomentSum sum(apex);
  double surface = 0;
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
    if (!mesh.isTriangle(i)) continue;
    const Vector3i& e = mesh.elements[i];
    const Vector3 &a = mesh.vertices[e[0]], &b = mesh.vertices[e[1]], &c = mesh.vertices[e[2]];
    sum.add((a - apex).dot((b - apex).cross(c - apex)) / 6, {apex, a, b, c});
    surface += area(a, b, c);
  }
  constexpr double ROUNDING = 1e-12;
  if (!(std::abs(sum.measure()) > ROUNDING * surface * box.diagonal().norm())) return false;
  const MassProperties properties = sum.properties(mass);
  if (mass > 0 && !isInertiaOfVolume(properties.inertia)) return false;
  *out = properties;
  return true;
}

MassProperties massFromSurface(const TriangleMesh& mesh, double mass) {
  if (mesh.elements.empty()) {
    MassProperties nothing;
    nothing.mass = mass;
    return nothing;
  }
  const Vector3 origin = mesh.bounds().center();
  MomentSum triangles(origin), segments(origin), points(origin);
  for (const Vector3i& e : mesh.elements) {
    const Vector3 &a = mesh.vertices[e[0]], &b = mesh.vertices[e[1]], &c = mesh.vertices[e[2]];
    triangles.add(area(a, b, c), {a, b, c});
    // Two corners of a segment coincide, so its longest side is the segment.
    const Vector3& far = (b - a).squaredNorm() > (c - a).squaredNorm() ? b : c;
    segments.add((far - a).norm(), {a, far});
    points.add(1, {a});
  }
  if (triangles.measure() > 0) return triangles.properties(mass);
  return segments.measure() > 0 ? segments.properties(mass) : points.properties(mass);
}

}  // namespace blem_sim::geometry
