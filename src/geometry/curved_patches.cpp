#include "curved_patches.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace blem_sim::geometry {
namespace {

constexpr double BOWED = 0.1;   // part of the heights' mean square that a surface of second order may leave
constexpr double SMOOTH = 0.5;  // part of the heights' range that a flat facet may climb

using Terms = Eigen::Matrix<double, 6, 1>;

/** Least squares of heights by terms, from sums. */
struct HeightFit {
  Eigen::Matrix<double, 6, 6> products = Eigen::Matrix<double, 6, 6>::Zero();
  Terms with_heights = Terms::Zero();
  double squares = 0;

  void add(const Terms& terms, double height) {
    products += terms * terms.transpose();
    with_heights += height * terms;
    squares += height * height;
  }
  /** Sum of squares that the first `count` terms leave; terms may depend on each other, as where all vertices lie on two lines. */
  double left(int count) const {
    const Eigen::MatrixXd matrix = products.topLeftCorner(count, count);
    const Eigen::VectorXd right = with_heights.head(count), factors = matrix.completeOrthogonalDecomposition().solve(right);
    return squares - 2 * factors.dot(right) + factors.dot(matrix * factors);
  }
};

/** A patch's vertices in its plane's frame. */
class PatchHeights {
 public:
  PatchHeights(const TriangleMesh& mesh, const PatchPlane& plane) : mesh_(mesh), plane_(plane) {
    Eigen::Index smallest = 0;
    plane.normal.cwiseAbs().minCoeff(&smallest);
    u_ = plane.normal.cross(Vector3::Unit(smallest)).normalized();
    v_ = plane.normal.cross(u_);
  }

  double height(int vertex) const { return plane_.normal.dot(mesh_.vertices[vertex] - plane_.centre); }

  /** @param begin, end (patch, vertex) */
  template <typename It>
  bool isBowed(It begin, It end) const {
    double size = 0;
    for (It it = begin; it != end; ++it) size = std::max(size, (mesh_.vertices[it->second] - plane_.centre).norm());
    HeightFit fit;
    for (It it = begin; it != end; ++it) {
      const Vector3 p = (mesh_.vertices[it->second] - plane_.centre) / size;
      const double x = u_.dot(p), y = v_.dot(p);
      fit.add((Terms() << 1, x, y, x * x, x * y, y * y).finished(), height(it->second));
    }
    constexpr int PLANE_TERMS = 3, ALL_TERMS = 6;
    return fit.left(ALL_TERMS) <= BOWED * fit.left(PLANE_TERMS);
  }

  template <typename It>
  double range(It begin, It end) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (It it = begin; it != end; ++it) {
      low = std::min(low, height(it->second));
      high = std::max(high, height(it->second));
    }
    return high - low;
  }

 private:
  const TriangleMesh& mesh_;
  const PatchPlane& plane_;
  Vector3 u_, v_;
};

/** By patch: [m] the most that a flat facet of it climbs, of one triangle or of several that continue one another. */
std::vector<double> steepestFacets(const MeshTopology& topology, const TriangleMesh& mesh, const std::vector<int>& patch_of,
                                   const std::vector<PatchPlane>& planes) {
  std::vector<double> steepest(planes.size(), 0), low(mesh.elements.size(), std::numeric_limits<double>::infinity()), high(low.size());
  for (std::size_t i = 0; i < patch_of.size(); ++i) {
    const int patch = patch_of[i], facet = topology.patchOf(static_cast<int>(i));
    if (patch < 0 || !planes[patch].asked) continue;
    if (std::isinf(low[facet])) high[facet] = -low[facet];
    const PatchHeights heights(mesh, planes[patch]);
    for (int k = 0; k < 3; ++k) {
      low[facet] = std::min(low[facet], heights.height(mesh.elements[i][k]));
      high[facet] = std::max(high[facet], heights.height(mesh.elements[i][k]));
    }
    steepest[patch] = std::max(steepest[patch], high[facet] - low[facet]);
  }
  return steepest;
}

}  // namespace

std::vector<char> findCurved(const MeshTopology& topology, const TriangleMesh& mesh, const std::vector<int>& patch_of,
                             const std::vector<PatchPlane>& planes) {
  std::vector<char> curved(planes.size(), 0);
  std::vector<std::pair<int, int>> vertices;  // (patch, vertex)
  for (std::size_t i = 0; i < patch_of.size(); ++i) {
    if (patch_of[i] < 0 || !planes[patch_of[i]].asked) continue;
    for (int k = 0; k < 3; ++k) vertices.emplace_back(patch_of[i], mesh.elements[i][k]);
  }
  if (vertices.empty()) return curved;
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const std::vector<double> steepest = steepestFacets(topology, mesh, patch_of, planes);
  for (auto begin = vertices.begin(), end = begin; begin != vertices.end(); begin = end) {
    const int patch = begin->first;
    end = std::find_if(begin, vertices.end(), [&](const auto& pair) { return pair.first != patch; });
    const PatchHeights heights(mesh, planes[patch]);
    curved[patch] = heights.isBowed(begin, end) || steepest[patch] <= SMOOTH * heights.range(begin, end);
  }
  return curved;
}

}  // namespace blem_sim::geometry
