#include "build/widths/scan_noise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace blem_sim::sim {
namespace {

constexpr int MOST_VERTICES = 5000, LEAST_VERTICES = 300;
constexpr double SHARP_COSINE = 0.5;
constexpr double MEDIAN_OF_NORMAL = 0.67448975;  // of absolute values, in standard deviations

struct Surface {
  const geometry::TriangleMesh& mesh;
  const geometry::MeshTopology& topology;

  /** Neighbours of a vertex; none if it lies on a border or where surfaces meet. */
  std::vector<int> ring(int vertex) const {
    std::vector<int> ring;
    for (const int edge : topology.edgesOf(vertex)) {
      if (topology.facesOf(edge).size() != 2) return {};
      ring.push_back(topology.otherEnd(mesh, edge, vertex));
    }
    return ring;
  }

  /** Unit normal of the faces around a vertex; nothing at a sharp edge. */
  std::optional<Vector3> normal(int vertex) const {
    Vector3 first = Vector3::Zero(), sum = Vector3::Zero();
    for (const int edge : topology.edgesOf(vertex)) {
      const geometry::EdgeFaces faces = topology.facesOf(edge);
      const Vector3 a = geometry::MeshTopology::normal(mesh, faces[0]), b = geometry::MeshTopology::normal(mesh, faces[1]);
      if (std::abs(a.dot(b)) < SHARP_COSINE) return std::nullopt;
      if (first.isZero(0)) first = a;
      for (const Vector3& n : {a, b}) sum += first.dot(n) < 0 ? Vector3(-n) : n;
    }
    if (!(sum.norm() > 0)) return std::nullopt;
    return sum.normalized();
  }
};

/** Weights of vertices in (I - A)^2 at one of them, A being the mean over a ring. Nothing next to a border. */
std::optional<std::map<int, double>> secondDifference(const Surface& surface, int vertex) {
  const std::vector<int> ring = surface.ring(vertex);
  if (ring.empty()) return std::nullopt;
  std::map<int, double> weights = {{vertex, 1}};
  const double part = 1.0 / static_cast<double>(ring.size());
  for (const int neighbour : ring) {
    const std::vector<int> next = surface.ring(neighbour);
    if (next.empty()) return std::nullopt;
    weights[neighbour] -= 2 * part;
    for (const int v : next) weights[v] += part / static_cast<double>(next.size());
  }
  return weights;
}

/** Size of the second difference at a vertex, in those of noise of 1 m. Nothing at borders and sharp edges. */
std::optional<double> deviation(const Surface& surface, int vertex) {
  const auto weights = secondDifference(surface, vertex);
  const auto normal = weights ? surface.normal(vertex) : std::nullopt;
  if (!normal) return std::nullopt;
  Vector3 difference = Vector3::Zero();
  double squares = 0;
  for (const auto& [v, weight] : *weights) {
    difference += weight * (surface.mesh.vertices[v] - surface.mesh.vertices[vertex]);
    squares += weight * weight;
  }
  return std::abs(normal->dot(difference)) / std::sqrt(squares);
}

}  // namespace

double scanNoise(const geometry::TriangleMesh& mesh, const geometry::MeshTopology& topology) {
  const Surface surface{mesh, topology};
  const int count = static_cast<int>(mesh.vertices.size()), stride = std::max(1, count / MOST_VERTICES);
  std::vector<double> deviations;
  for (int vertex = 0; vertex < count; vertex += stride)
    if (const auto d = deviation(surface, vertex)) deviations.push_back(*d);
  if (deviations.size() < LEAST_VERTICES) return 0;
  const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
  std::nth_element(deviations.begin(), middle, deviations.end());
  return *middle / MEDIAN_OF_NORMAL;
}

}  // namespace blem_sim::sim
