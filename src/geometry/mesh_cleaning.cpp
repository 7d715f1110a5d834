#include <tbb/blocked_range.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include "blem_sim/geometry/for_all.h"
#include "blem_sim/geometry/triangle_mesh.h"
#include "place_hash.h"
#include "sides_by_vertex.h"
#include "threads/first_equals.h"

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

/** Keeps the items for whose index isKept(index) holds, in their order. */
template <typename T, typename IsKept>
void keepOnly(IsKept&& isKept, std::vector<T>* items) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < items->size(); ++i) {
    if (isKept(i)) (*items)[kept++] = (*items)[i];
  }
  items->resize(kept);
}

/** Whether firstEquals found no equal ones. */
bool allDiffer(const std::vector<int>& first) {
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i] != static_cast<int>(i)) return false;
  }
  return true;
}

/** Drops elements that repeat an earlier one, either winding. @return their number */
int dropRepeated(std::vector<Vector3i>* elements) {
  const auto key = [elements](int i) { return sorted((*elements)[static_cast<std::size_t>(i)]); };
  const std::size_t given = elements->size();
  const std::vector<int> first = firstEquals(
      static_cast<int>(given), [&](int i) { return elementHash(key(i)); }, [&](int i, int j) { return key(i) == key(j); });
  if (!allDiffer(first)) keepOnly([&](std::size_t i) { return first[i] == static_cast<int>(i); }, elements);
  return static_cast<int>(given - elements->size());
}

/** Counts the edges of triangles by their numbers of triangles. */
void countEdges(const TriangleMesh& mesh, MeshReport* report) {
  struct Counts {
    int edges = 0, open = 0, nonmanifold = 0;
    Counts operator+(const Counts& other) const { return {edges + other.edges, open + other.open, nonmanifold + other.nonmanifold}; }
  };
  const SidesByVertex by_vertex(mesh);
  const auto isOfTriangle = [&](const Side& side) { return mesh.isTriangle(side.element()); };
  const Counts counts = sumOfParts(
      tbb::blocked_range<int>(0, static_cast<int>(mesh.vertices.size()), FEW_ITEMS), Counts(),
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
void dropUnusable(RepeatedIndices repeated, TriangleMesh* mesh, MeshReport* report) {
  const int vertex_count = static_cast<int>(mesh->vertices.size());
  // Triangles are told from segments by the file's own indices: after welding a collapsed triangle would look like a segment.
  const bool segments_allowed = repeated == RepeatedIndices::ARE_SEGMENTS_AND_POINTS;
  const auto fateOf = [&](const Vector3i& e) {
    if (e.minCoeff() < 0 || e.maxCoeff() >= vertex_count) return Fate::INVALID;
    const Vector3 &a = mesh->vertices[e[0]], &b = mesh->vertices[e[1]], &c = mesh->vertices[e[2]];
    if (!isFinite(a) || !isFinite(b) || !isFinite(c)) return Fate::NONFINITE;
    const bool is_triangle = e[0] != e[1] && e[1] != e[2] && e[2] != e[0];
    return (is_triangle ? hasArea(a, b, c) : segments_allowed) ? Fate::KEPT : Fate::DEGENERATE;
  };
  std::vector<Fate> fates(mesh->elements.size());
  forAll(fates.size(), [&](std::size_t i) { fates[i] = fateOf(mesh->elements[i]); });
  const auto count = [&](Fate fate) { return static_cast<int>(std::count(fates.begin(), fates.end(), fate)); };
  report->invalid = count(Fate::INVALID);
  report->nonfinite = count(Fate::NONFINITE);
  report->degenerate = count(Fate::DEGENERATE);
  if (report->invalid + report->nonfinite + report->degenerate == 0) return;
  keepOnly([&](std::size_t i) { return fates[i] == Fate::KEPT; }, &mesh->elements);
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
  if (allDiffer(first)) return;
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

/** Whether an element uses the vertex, by vertex. */
std::vector<std::uint8_t> usedVertices(const TriangleMesh& mesh) {
  std::vector<std::atomic<std::uint8_t>> used(mesh.vertices.size());
  forAll(mesh.elements.size(), [&](std::size_t i) {
    for (int k = 0; k < 3; ++k) used[mesh.elements[i][k]].store(1, std::memory_order_relaxed);
  });
  return std::vector<std::uint8_t>(used.begin(), used.end());
}

/** Drops the vertices that no element uses; the others keep their order. */
void dropUnusedVertices(TriangleMesh* mesh) {
  const std::vector<std::uint8_t> used = usedVertices(*mesh);
  if (std::find(used.begin(), used.end(), 0) == used.end()) return;
  std::vector<int> used_below(used.size());
  int count = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    used_below[i] = count;
    count += used[i];
  }
  forAll(mesh->elements.size(), [&](std::size_t i) {
    Vector3i& e = mesh->elements[i];
    e = {used_below[e[0]], used_below[e[1]], used_below[e[2]]};
  });
  keepOnly([&](std::size_t i) { return used[i] != 0; }, &mesh->vertices);
}

void describeResult(const TriangleMesh& mesh, MeshReport* report) {
  const int elements = static_cast<int>(mesh.elements.size());
  const auto count = [elements](auto&& isOne) {
    return sumOfParts(tbb::blocked_range<int>(0, elements, FEW_ITEMS), 0, [&](const tbb::blocked_range<int>& range, int sum) {
      for (int i = range.begin(); i < range.end(); ++i) sum += isOne(i);
      return sum;
    });
  };
  report->vertices = static_cast<int>(mesh.vertices.size());
  report->triangles = count([&](int i) { return mesh.isTriangle(i); });
  report->points = report->triangles == elements ? 0 : count([&](int i) { return mesh.isPoint(i); });
  report->segments = elements - report->triangles - report->points;
  report->extents = mesh.bounds();
  countEdges(mesh, report);
}

void clearCounts(MeshReport* report) { report->degenerate = report->duplicate = report->nonfinite = report->invalid = report->welded = 0; }

}  // namespace

TriangleMesh cleanMesh(TriangleMesh mesh, MeshReport* report, RepeatedIndices repeated) {
  MeshReport unwanted;
  if (!report) report = &unwanted;
  clearCounts(report);
  dropUnusable(repeated, &mesh, report);
  weld(mesh.vertices, &mesh.elements, report);
  report->duplicate = dropRepeated(&mesh.elements);
  dropUnusedVertices(&mesh);
  mesh.vertices.shrink_to_fit();
  mesh.elements.shrink_to_fit();
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
