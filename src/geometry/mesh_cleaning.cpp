#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "blem_sim/geometry/triangle_mesh.h"
#include "place_hash.h"

namespace blem_sim {
namespace {

constexpr double MAX_COORDINATE = 1e30;
/** A triangle lower than this part of its longest side has no area but rounding. */
constexpr double MIN_RELATIVE_HEIGHT = 1e-12;

bool isFinite(const Vector3& v) { return (v.array().abs() <= MAX_COORDINATE).all(); }

bool hasArea(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a, bc = c - b, ca = a - c;
  const double longest = std::sqrt(std::max({ab.squaredNorm(), bc.squaredNorm(), ca.squaredNorm()}));
  // Of unit size before the product, which would lose a triangle of 1e-100 m or 1e100 m.
  return longest > 0 && (ab / longest).cross(ca / longest).norm() > MIN_RELATIVE_HEIGHT;
}

/** Finds, for a position, the first vertex there. Open addressing; -0.0 is 0.0. */
class PositionIndex {
 public:
  explicit PositionIndex(const std::vector<Vector3>& vertices) : vertices_(vertices) {
    std::size_t slots = 16;
    while (slots < 2 * vertices.size()) slots *= 2;
    slots_.assign(slots, EMPTY);
  }

  int firstAt(int vertex) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = placeHash(vertices_[vertex]) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == EMPTY) return slots_[slot] = vertex;
      if (vertices_[slots_[slot]] == vertices_[vertex]) return slots_[slot];
    }
  }

 private:
  static constexpr int EMPTY = -1;

  const std::vector<Vector3>& vertices_;
  std::vector<int> slots_;
};

/** Indices of `count` items grouped by a key in [0, keys), each group in the items' order: a counting sort. */
template <typename Key>
std::vector<int> groupedBy(int count, int keys, Key&& key) {
  std::vector<int> start(keys + 1, 0), grouped(count);
  for (int i = 0; i < count; ++i) ++start[key(i) + 1];
  for (int k = 0; k < keys; ++k) start[k + 1] += start[k];
  for (int i = 0; i < count; ++i) grouped[start[key(i)]++] = i;
  return grouped;
}

/** The vertices in ascending order; a segment's third index repeats the higher one, whichever was repeated. */
Vector3i sorted(const Vector3i& e) {
  const int low = e.minCoeff(), high = e.maxCoeff();
  for (int k = 0; k < 3; ++k) {
    if (e[k] != low && e[k] != high) return {low, e[k], high};
  }
  return {low, high, high};
}

/** Which elements repeat an earlier one, either winding. */
std::vector<bool> repeats(const std::vector<Vector3i>& elements, int vertex_count) {
  const int count = static_cast<int>(elements.size());
  std::vector<Vector3i> keys(count);
  std::transform(elements.begin(), elements.end(), keys.begin(), sorted);
  std::vector<int> order = groupedBy(count, vertex_count, [&](int i) { return keys[i][0]; });
  std::vector<bool> repeated(count, false);
  const auto before = [&](int i, int j) { return std::make_tuple(keys[i][1], keys[i][2], i) < std::make_tuple(keys[j][1], keys[j][2], j); };
  for (int begin = 0, end = 0; begin < count; begin = end) {
    while (end < count && keys[order[end]][0] == keys[order[begin]][0]) ++end;
    std::sort(order.begin() + begin, order.begin() + end, before);
    for (int i = begin + 1; i < end; ++i) repeated[order[i]] = keys[order[i]] == keys[order[i - 1]];
  }
  return repeated;
}

/** Counts the edges of triangles by how many triangles they have. */
void countEdges(const TriangleMesh& mesh, MeshReport* report) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(3 * mesh.elements.size());
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
    if (!mesh.isTriangle(i)) continue;
    const Vector3i& e = mesh.elements[i];
    for (int k = 0; k < 3; ++k) edges.push_back(std::minmax({e[k], e[(k + 1) % 3]}));
  }
  const int count = static_cast<int>(edges.size());
  const std::vector<int> order = groupedBy(count, static_cast<int>(mesh.vertices.size()), [&](int i) { return edges[i].first; });
  report->open_edges = report->nonmanifold_edges = 0;
  std::vector<int> ends;
  for (int begin = 0, end = 0; begin < count; begin = end) {
    ends.clear();
    for (; end < count && edges[order[end]].first == edges[order[begin]].first; ++end) ends.push_back(edges[order[end]].second);
    std::sort(ends.begin(), ends.end());
    for (auto it = ends.begin(); it != ends.end();) {
      const auto next = std::upper_bound(it, ends.end(), *it);
      if (next - it == 1) ++report->open_edges;
      if (next - it > 2) ++report->nonmanifold_edges;
      it = next;
    }
  }
  report->closed = count > 0 && report->open_edges == 0 && report->nonmanifold_edges == 0;
}

/** Drops the elements whose indices or coordinates cannot be used. */
std::vector<Vector3i> usableElements(const TriangleMesh& soup, MeshReport* report) {
  std::vector<Vector3i> usable;
  usable.reserve(soup.elements.size());
  const int vertex_count = static_cast<int>(soup.vertices.size());
  for (const Vector3i& e : soup.elements) {
    if (e.minCoeff() < 0 || e.maxCoeff() >= vertex_count) {
      ++report->invalid;
    } else if (!isFinite(soup.vertices[e[0]]) || !isFinite(soup.vertices[e[1]]) || !isFinite(soup.vertices[e[2]])) {
      ++report->nonfinite;
    } else {
      usable.push_back(e);
    }
  }
  return usable;
}

/** Lets equal positions share the first vertex there. */
void weld(const std::vector<Vector3>& vertices, std::vector<Vector3i>* elements, MeshReport* report) {
  constexpr int UNSEEN = -1;
  std::vector<int> first_at(vertices.size(), UNSEEN);
  PositionIndex index(vertices);
  for (Vector3i& e : *elements) {
    for (int k = 0; k < 3; ++k) {
      int& first = first_at[e[k]];
      if (first == UNSEEN) {
        first = index.firstAt(e[k]);
        if (first != e[k]) ++report->welded;
      }
      e[k] = first;
    }
  }
}

/** Drops the vertices that no element uses; the others keep their order. */
TriangleMesh withoutUnusedVertices(const std::vector<Vector3>& vertices, std::vector<Vector3i> elements) {
  std::vector<int> new_index(vertices.size(), 0);
  for (const Vector3i& e : elements) {
    for (int k = 0; k < 3; ++k) new_index[e[k]] = 1;
  }
  TriangleMesh mesh;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (new_index[i] == 0) continue;
    new_index[i] = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(vertices[i]);
  }
  for (Vector3i& e : elements) e = {new_index[e[0]], new_index[e[1]], new_index[e[2]]};
  mesh.elements = std::move(elements);
  return mesh;
}

void describeResult(const TriangleMesh& mesh, MeshReport* report) {
  report->vertices = static_cast<int>(mesh.vertices.size());
  report->triangles = report->segments = report->points = 0;
  for (int i = 0; i < static_cast<int>(mesh.elements.size()); ++i) {
    ++(mesh.isTriangle(i) ? report->triangles : mesh.isPoint(i) ? report->points : report->segments);
  }
  report->extents = mesh.bounds();
  countEdges(mesh, report);
}

void clearCounts(MeshReport* report) { report->degenerate = report->duplicate = report->nonfinite = report->invalid = report->welded = 0; }

}  // namespace

TriangleMesh cleanMesh(const TriangleMesh& soup, MeshReport* report, RepeatedIndices repeated) {
  MeshReport unwanted;
  if (!report) report = &unwanted;
  clearCounts(report);
  std::vector<Vector3i> elements = usableElements(soup, report);

  // Triangles are told from segments by the file's own indices: after welding a collapsed triangle would look like a segment.
  const bool segments_allowed = repeated == RepeatedIndices::ARE_SEGMENTS_AND_POINTS;
  const auto isDegenerate = [&](const Vector3i& e) {
    const bool is_triangle = e[0] != e[1] && e[1] != e[2] && e[2] != e[0];
    return is_triangle ? !hasArea(soup.vertices[e[0]], soup.vertices[e[1]], soup.vertices[e[2]]) : !segments_allowed;
  };
  const auto with_area_end = std::remove_if(elements.begin(), elements.end(), isDegenerate);
  report->degenerate = static_cast<int>(elements.end() - with_area_end);
  elements.erase(with_area_end, elements.end());

  weld(soup.vertices, &elements, report);

  const std::vector<bool> repeats_earlier = repeats(elements, static_cast<int>(soup.vertices.size()));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!repeats_earlier[i]) elements[kept++] = elements[i];
  }
  report->duplicate = static_cast<int>(elements.size() - kept);
  elements.resize(kept);

  TriangleMesh mesh = withoutUnusedVertices(soup.vertices, std::move(elements));
  describeResult(mesh, report);
  return mesh;
}

TriangleMesh pointCloudMesh(const std::vector<Vector3>& points, MeshReport* report) {
  MeshReport unwanted;
  if (!report) report = &unwanted;
  clearCounts(report);
  TriangleMesh mesh;
  PositionIndex index(points);
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    if (!isFinite(points[i])) {
      ++report->nonfinite;
    } else if (index.firstAt(i) != i) {
      ++report->welded;
    } else {
      const int vertex = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(points[i]);
      mesh.elements.emplace_back(vertex, vertex, vertex);
    }
  }
  describeResult(mesh, report);
  return mesh;
}

}  // namespace blem_sim
