#include "blem_sim/geometry/triangle_mesh.h"

#include <tbb/blocked_range.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "blem_sim/geometry/for_all.h"

namespace blem_sim::geometry {

Box TriangleMesh::bounds() const {
  using Range = tbb::blocked_range<std::size_t>;
  const auto extended = [this](const Range& range, Box box) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      for (int k = 0; k < 3; ++k) box.extend(vertices[elements[i][k]]);
    return box;
  };
  return sumOfParts(Range(0, elements.size(), FEW_ITEMS), Box(), extended, [](const Box& a, const Box& b) { return a.merged(b); });
}

TriangleMesh transformed(const TriangleMesh& mesh, const Pose& X_AB, const Vector3& scale) {
  TriangleMesh result = mesh;
  for (Vector3& v : result.vertices) v = X_AB * v.cwiseProduct(scale);
  // A mirror image turns outside in; the other winding turns it back.
  if (scale.prod() < 0) {
    for (Vector3i& e : result.elements) std::swap(e[1], e[2]);
  }
  return result;
}

namespace {

/** Gives each edge one vertex in its middle. */
class EdgeMidpoints {
 public:
  explicit EdgeMidpoints(std::vector<Vector3>* vertices) : vertices_(*vertices) {}

  int operator()(int i, int j) {
    if (i == j) return i;
    if (i > j) std::swap(i, j);
    const std::uint64_t key = (static_cast<std::uint64_t>(i) << 32) | static_cast<std::uint32_t>(j);
    const auto [entry, is_new] = index_.try_emplace(key, static_cast<int>(vertices_.size()));
    if (is_new) vertices_.push_back(0.5 * (vertices_[i] + vertices_[j]));
    return entry->second;
  }

 private:
  std::vector<Vector3>& vertices_;
  std::unordered_map<std::uint64_t, int> index_;
};

TriangleMesh subdividedOnce(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.vertices = mesh.vertices;
  result.elements.reserve(4 * mesh.elements.size());
  EdgeMidpoints midpoint(&result.vertices);
  for (const Vector3i& e : mesh.elements) {
    const bool is_point = e[0] == e[1] && e[1] == e[2];
    const bool is_triangle = e[0] != e[1] && e[1] != e[2] && e[2] != e[0];
    if (is_point) {
      result.elements.push_back(e);
    } else if (is_triangle) {
      const int m01 = midpoint(e[0], e[1]), m12 = midpoint(e[1], e[2]), m20 = midpoint(e[2], e[0]);
      result.elements.insert(result.elements.end(), {{e[0], m01, m20}, {m01, e[1], m12}, {m20, m12, e[2]}, {m01, m12, m20}});
    } else {
      const int p = e[0], q = e[1] != p ? e[1] : e[2], m = midpoint(p, q);
      result.elements.insert(result.elements.end(), {{p, m, m}, {m, q, q}});
    }
  }
  return result;
}

}  // namespace

TriangleMesh subdivided(const TriangleMesh& mesh, int level) {
  TriangleMesh result = mesh;
  for (int i = 0; i < level; ++i) result = subdividedOnce(result);
  return result;
}

}  // namespace blem_sim::geometry
