#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include "blem_sim/geometry/triangle_mesh.h"
#include "first_equals.h"
#include "place_hash.h"
#include "sides_by_vertex.h"

namespace blem_sim::geometry {
namespace {

constexpr double MAX_COORDINATE = 1e30;
/** A triangle lower than this part of its longest side has no area but rounding. */
constexpr double DEGENERATE_HEIGHT = 1e-12;
constexpr int NONE = -1;

bool isFinite(const Vector3& v) { return (v.array().abs() <= MAX_COORDINATE).all(); }

bool hasArea(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a, bc = c - b, ca = a - c;
  const double longest2 = std::max({ab.squaredNorm(), bc.squaredNorm(), ca.squaredNorm()});
  // Nearly all triangles need no root and no quotient.
  constexpr double PLENTY = 1e4 * DEGENERATE_HEIGHT * DEGENERATE_HEIGHT, SMALL = 1e-60, LARGE = 1e60;
  if (longest2 > SMALL && longest2 < LARGE && ab.cross(ca).squaredNorm() > PLENTY * longest2 * longest2) return true;
  const double longest = std::sqrt(longest2);
  // Scaled to unit size before the product, which would lose a triangle of 1e-100 m or 1e100 m.
  return longest > 0 && (ab / longest).cross(ca / longest).norm() > DEGENERATE_HEIGHT;
}

/** The vertices in ascending order; a segment's third index repeats the higher one, whichever was repeated. */
Vector3i sorted(const Vector3i& e) {
  const int low = std::min({e[0], e[1], e[2]}), high = std::max({e[0], e[1], e[2]});
  const int middle = e[0] ^ e[1] ^ e[2] ^ low ^ high;
  return {low, middle == low ? high : middle, high};
}

std::uint64_t elementHash(const Vector3i& sorted_corners) {
  std::uint64_t h = 0;
  for (int k = 0; k < 3; ++k) h = hashedOn(h, static_cast<std::uint64_t>(sorted_corners[k]));
  return h;
}

/** Drops elements that repeat an earlier one, either winding. @return their number */
int dropRepeated(std::vector<Vector3i>* elements) {
  std::vector<Vector3i> keys(elements->size());
  tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) { keys[i] = sorted((*elements)[i]); });
  const std::vector<int> first = firstEquals(
      static_cast<int>(keys.size()), [&](int i) { return elementHash(keys[i]); }, [&](int i, int j) { return keys[i] == keys[j]; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < elements->size(); ++i) {
    if (first[i] == static_cast<int>(i)) (*elements)[kept++] = (*elements)[i];
  }
  const int dropped = static_cast<int>(elements->size() - kept);
  elements->resize(kept);
  return dropped;
}

/** Counts the edges of triangles by their numbers of triangles. */
void countEdges(const TriangleMesh& mesh, MeshReport* report) {
  struct Counts {
    int edges = 0, open = 0, nonmanifold = 0;
    Counts operator+(const Counts& other) const { return {edges + other.edges, open + other.open, nonmanifold + other.nonmanifold}; }
  };
  const SidesByVertex by_vertex(mesh);
  const auto isOfTriangle = [&](const Side& side) { return mesh.isTriangle(side.element()); };
  const Counts counts = tbb::parallel_reduce(
      tbb::blocked_range<int>(0, static_cast<int>(mesh.vertices.size())), Counts(),
      [&](const tbb::blocked_range<int>& range, Counts sum) {
        for (int v = range.begin(); v < range.end(); ++v) {
          visitEdges(by_vertex, v, [&](const Side* first, const Side* last) {
            const auto triangles = report->segments > 0 ? std::count_if(first, last, isOfTriangle) : last - first;
            sum.edges += triangles > 0;
            sum.open += triangles == 1;
            sum.nonmanifold += triangles > 2;
          });
        }
        return sum;
      },
      std::plus<Counts>());
  report->open_edges = counts.open;
  report->nonmanifold_edges = counts.nonmanifold;
  report->closed = counts.edges > 0 && counts.open == 0 && counts.nonmanifold == 0;
}

enum class Fate : std::uint8_t { KEPT, INVALID, NONFINITE, DEGENERATE };

/** Drops the elements whose indices or coordinates cannot be used, and those without area. */
std::vector<Vector3i> usableElements(const TriangleMesh& soup, RepeatedIndices repeated, MeshReport* report) {
  const int vertex_count = static_cast<int>(soup.vertices.size());
  // Triangles are told from segments by the file's own indices: after welding a collapsed triangle would look like a segment.
  const bool segments_allowed = repeated == RepeatedIndices::ARE_SEGMENTS_AND_POINTS;
  const auto fateOf = [&](const Vector3i& e) {
    if (e.minCoeff() < 0 || e.maxCoeff() >= vertex_count) return Fate::INVALID;
    const Vector3 &a = soup.vertices[e[0]], &b = soup.vertices[e[1]], &c = soup.vertices[e[2]];
    if (!isFinite(a) || !isFinite(b) || !isFinite(c)) return Fate::NONFINITE;
    const bool is_triangle = e[0] != e[1] && e[1] != e[2] && e[2] != e[0];
    return (is_triangle ? hasArea(a, b, c) : segments_allowed) ? Fate::KEPT : Fate::DEGENERATE;
  };
  std::vector<Fate> fates(soup.elements.size());
  tbb::parallel_for(std::size_t{0}, fates.size(), [&](std::size_t i) { fates[i] = fateOf(soup.elements[i]); });
  const auto count = [&](Fate fate) { return static_cast<int>(std::count(fates.begin(), fates.end(), fate)); };
  report->invalid = count(Fate::INVALID);
  report->nonfinite = count(Fate::NONFINITE);
  report->degenerate = count(Fate::DEGENERATE);
  std::vector<Vector3i> usable;
  usable.reserve(static_cast<std::size_t>(count(Fate::KEPT)));
  for (std::size_t i = 0; i < fates.size(); ++i) {
    if (fates[i] == Fate::KEPT) usable.push_back(soup.elements[i]);
  }
  return usable;
}

/** For each vertex the first one at exactly its position; a vertex that is not finite is alone. */
std::vector<int> firstAt(const std::vector<Vector3>& vertices) {
  return firstEquals(
      static_cast<int>(vertices.size()),
      [&](int i) { return isFinite(vertices[i]) ? placeHash(vertices[i]) : hashedOn(0, static_cast<std::uint64_t>(i)); },
      [&](int i, int j) { return i == j || vertices[i] == vertices[j]; });
}

/** Lets equal positions share the vertex there that is used first. */
void weld(const std::vector<Vector3>& vertices, std::vector<Vector3i>* elements, MeshReport* report) {
  const std::vector<int> first = firstAt(vertices);
  std::vector<int> used_at(vertices.size(), NONE);
  std::vector<std::uint8_t> used(vertices.size(), 0);
  for (Vector3i& e : *elements) {
    for (int k = 0; k < 3; ++k) {
      int& shared = used_at[first[e[k]]];
      if (shared == NONE) shared = e[k];
      report->welded += shared != e[k] && !used[e[k]];
      used[e[k]] = 1;
      e[k] = shared;
    }
  }
}

/** Drops the vertices that no element uses; the others keep their order. */
TriangleMesh withoutUnusedVertices(const std::vector<Vector3>& vertices, std::vector<Vector3i> elements) {
  std::vector<int> new_index(vertices.size(), NONE);
  for (const Vector3i& e : elements) {
    for (int k = 0; k < 3; ++k) new_index[e[k]] = 0;
  }
  TriangleMesh mesh;
  mesh.vertices.reserve(vertices.size() - static_cast<std::size_t>(std::count(new_index.begin(), new_index.end(), NONE)));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (new_index[i] == NONE) continue;
    new_index[i] = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(vertices[i]);
  }
  tbb::parallel_for(std::size_t{0}, elements.size(), [&](std::size_t i) {
    Vector3i& e = elements[i];
    e = {new_index[e[0]], new_index[e[1]], new_index[e[2]]};
  });
  elements.shrink_to_fit();
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
  std::vector<Vector3i> elements = usableElements(soup, repeated, report);
  weld(soup.vertices, &elements, report);
  report->duplicate = dropRepeated(&elements);
  TriangleMesh mesh = withoutUnusedVertices(soup.vertices, std::move(elements));
  describeResult(mesh, report);
  return mesh;
}

TriangleMesh pointCloudMesh(const std::vector<Vector3>& points, MeshReport* report) {
  MeshReport unwanted;
  if (!report) report = &unwanted;
  clearCounts(report);
  const std::vector<int> first = firstAt(points);
  TriangleMesh mesh;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    if (!isFinite(points[i])) {
      ++report->nonfinite;
    } else if (first[i] != i) {
      ++report->welded;
    } else {
      const int vertex = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(points[i]);
      mesh.elements.emplace_back(vertex, vertex, vertex);
    }
  }
  mesh.vertices.shrink_to_fit();
  mesh.elements.shrink_to_fit();
  describeResult(mesh, report);
  return mesh;
}

}  // namespace blem_sim::geometry
