#include "mesh_borders.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blem_sim/geometry/collected.h"
#include "place_hash.h"

namespace blem_sim::geometry {
namespace {

/** Inward directions closer than this (cosine, 18 deg) are two sheets, not a surface and its continuation. */
constexpr double SHEETS_COSINE = 0.95;
/** Joined ends are closer than this part of their edges, so that no triangle is lost. */
constexpr double REACH_OF_LENGTH = 0.25;

/** Places in cells, to find those near a place. Open hashing. */
class PlaceGrid {
 public:
  PlaceGrid(double reach, int count) : reach_(reach), cell_size_(8 * reach), next_(count, NONE) {
    std::size_t slots = 16;
    while (slots < 2 * static_cast<std::size_t>(count)) slots *= 2;
    first_.assign(slots, NONE);
    cells_.resize(count);
  }

  void add(int item, const Vector3& place) {
    cells_[item] = cellOf(place);
    int& first = first_[slotOf(cells_[item])];
    next_[item] = first;
    first = item;
  }

  /** Calls visit(item) for each item within reach of the place, and some more. */
  template <typename Visit>
  void visitNear(const Vector3& place, Visit&& visit) const {
    const Vector3 lower = cellOf(place - Vector3::Constant(reach_)), upper = cellOf(place + Vector3::Constant(reach_));
    for (int corner = 0; corner < 8; ++corner) {
      Vector3 cell = lower;
      bool repeated = false;
      for (int k = 0; k < 3; ++k) {
        if (!(corner >> k & 1)) continue;
        repeated = repeated || upper[k] == lower[k];
        cell[k] = upper[k];
      }
      if (repeated) continue;
      for (int item = first_[slotOf(cell)]; item != NONE; item = next_[item]) {
        if (cells_[item] == cell) visit(item);
      }
    }
  }

 private:
  static constexpr int NONE = -1;

  Vector3 cellOf(const Vector3& place) const { return (place / cell_size_).array().floor(); }

  std::size_t slotOf(const Vector3& cell) const { return placeHash(cell) & (first_.size() - 1); }

  double reach_, cell_size_;
  std::vector<int> first_, next_;
  std::vector<Vector3> cells_;
};

/** Two borders, the ends of f in the order of e's. */
struct Match {
  int e, f;
  bool crossed;
  double distance;  ///< [m] larger one of the ends' distances
};

class Matcher {
 public:
  Matcher(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<Border>& borders)
      : mesh_(mesh), topology_(topology), borders_(borders), nearest_(borders.size(), std::numeric_limits<double>::infinity()) {}

  void find() {
    const double reach = longestReach(borders_);
    if (!(reach > 0)) return;
    PlaceGrid grid(reach, static_cast<int>(borders_.size()));
    for (int f = 0; f < static_cast<int>(borders_.size()); ++f) {
      const Vector3 middle = 0.5 * (mesh_.vertices[borders_[f].a] + mesh_.vertices[borders_[f].b]);
      grid.visitNear(middle, [&](int e) { add(e, f); });
      grid.add(f, middle);
    }
  }

  const std::vector<Match>& matches() const { return matches_; }
  bool isNearest(const Match& match) const { return match.distance <= std::max(nearest_[match.e], nearest_[match.f]) + SAME; }

 private:
  static constexpr double SAME = 1e-9;  // [m] partners as near as each other

  bool mayJoin(int vertex, int other) const { return vertex == other || !areNeighbours(mesh_, topology_, vertex, other); }

  void add(int e, int f) {
    const Border &first = borders_[e], &second = borders_[f];
    const auto apart = [this](int vertex, int other) { return (mesh_.vertices[vertex] - mesh_.vertices[other]).norm(); };
    const double straight = std::max(apart(first.a, second.a), apart(first.b, second.b));
    const double across = std::max(apart(first.a, second.b), apart(first.b, second.a));
    const Match match{e, f, across < straight, std::min(straight, across)};
    if (match.distance > reachOf(first, second) || !mayContinue(first, second)) return;
    if (!mayJoin(first.a, match.crossed ? second.b : second.a) || !mayJoin(first.b, match.crossed ? second.a : second.b)) return;
    nearest_[e] = std::min(nearest_[e], match.distance);
    nearest_[f] = std::min(nearest_[f], match.distance);
    matches_.push_back(match);
  }

  const TriangleMesh& mesh_;
  const MeshTopology& topology_;
  const std::vector<Border>& borders_;
  std::vector<double> nearest_;
  std::vector<Match> matches_;
};

}  // namespace

std::vector<Border> bordersOf(const TriangleMesh& mesh, const MeshTopology& topology) {
  return collected<Border>(static_cast<int>(mesh.elements.size()), [&](int face, std::vector<Border>* borders) {
    if (!topology.isFace(face)) return;
    const Vector3i& corners = mesh.elements[face];
    for (int side = 0; side < 3; ++side) {
      const int edge = topology.edgeOf(face, side);
      if (topology.facesOf(edge).size() != 1) continue;
      const int a = corners[side], b = corners[(side + 1) % 3];
      const double length = (mesh.vertices[b] - mesh.vertices[a]).norm();
      borders->push_back({face, side, a, b, length, topology.inward(mesh, edge, face), corners});
    }
  });
}

bool mayContinue(const Border& e, const Border& f) {
  int shared = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) shared += e.corners[i] == f.corners[j];
  }
  return shared < 2 && e.inward.dot(f.inward) < SHEETS_COSINE;
}

double reachOf(const Border& e, const Border& f) { return std::min(CRACK_WIDTH, REACH_OF_LENGTH * std::min(e.length, f.length)); }

double longestReach(const std::vector<Border>& borders) {
  double longest = 0;
  for (const Border& border : borders) longest = std::max(longest, reachOf(border, border));
  return longest;
}

bool areNeighbours(const TriangleMesh& mesh, const MeshTopology& topology, int vertex, int other) {
  const VertexEdges edges = topology.edgesOf(vertex);
  return std::any_of(edges.begin(), edges.end(), [&](int edge) { return topology.otherEnd(mesh, edge, vertex) == other; });
}

TriangleMesh VertexClusters::applied(const TriangleMesh& mesh, const std::vector<Vector3>& places) {
  TriangleMesh joined;
  joined.vertices = places;
  std::vector<int> members(places.size(), 1);
  for (int i = 0; i < static_cast<int>(places.size()); ++i) {
    const int into = sets_.first(i);
    if (into == i) continue;
    ++members[into];
    joined.vertices[into] += places[i] - places[into];
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i] > 1) joined.vertices[i] = places[i] + (joined.vertices[i] - places[i]) / members[i];
  }
  joined.elements.reserve(mesh.elements.size());
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    const Vector3i& e = mesh.elements[i];
    const Vector3i into(sets_.first(e[0]), sets_.first(e[1]), sets_.first(e[2]));
    const bool collapsed = into[0] == into[1] || into[1] == into[2] || into[2] == into[0];
    if (!collapsed || !mesh.isTriangle(static_cast<int>(i))) joined.elements.push_back(into);
  }
  return joined;
}

std::vector<double> VertexClusters::spreads(const TriangleMesh& joined, const std::vector<Vector3>& places) {
  std::vector<double> spreads(places.size(), 0);
  for (int i = 0; i < static_cast<int>(places.size()); ++i) {
    const int into = sets_.first(i);
    spreads[into] = std::max(spreads[into], (places[i] - joined.vertices[into]).norm());
  }
  return spreads;
}

void joinMatching(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<Border>& borders, VertexClusters* clusters,
                  MeshMending* what) {
  Matcher matcher(mesh, topology, borders);
  matcher.find();
  for (const Match& match : matcher.matches()) {
    if (!matcher.isNearest(match)) continue;
    const Border &e = borders[match.e], &f = borders[match.f];
    clusters->join(e.a, match.crossed ? f.b : f.a);
    clusters->join(e.b, match.crossed ? f.a : f.b);
    what->widest_crack = std::max(what->widest_crack, match.distance);
    ++what->cracks;
  }
}

}  // namespace blem_sim::geometry
