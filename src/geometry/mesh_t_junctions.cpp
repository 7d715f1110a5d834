// Borders that lie side by side over a part of their length.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "blem_sim/geometry/bvh_traversal.h"
#include "mesh_borders.h"

namespace blem_sim::geometry {
namespace {

constexpr double SAME = 1e-9;  // [m] partners as near as each other
/** Borders overlap if they lie side by side over this many times the distance allowed: crossing or touching ends are none. */
constexpr double MIN_OVERLAP = 3;
/** Pairs of borders that are looked at, at most: seconds. Surfaces have tens per border; long borders all across each other have as many
 *  as there are pairs. */
constexpr std::size_t MOST_PAIRS = 20000000, MOST_PAIRS_PER_BORDER = 500;

/** The point of a segment that is nearest to p, from 0 at the beginning to 1 at the end. */
double nearestParameter(const Vector3& p, const Vector3& from, const Vector3& to) {
  const Vector3 along = to - from;
  return std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
}

struct Overlap {
  int e, f;
  double distance;  ///< [m] largest distance of an end from the other border
};

class OverlapFinder {
 public:
  OverlapFinder(const TriangleMesh& mesh, const std::vector<Border>& borders)
      : mesh_(mesh),
        borders_(borders),
        most_pairs_(std::max(MOST_PAIRS, MOST_PAIRS_PER_BORDER * borders.size())),
        nearest_(borders.size(), std::numeric_limits<double>::infinity()) {}

  /** @return false if there are too many pairs to look at; then there are no overlaps */
  bool find() {
    TriangleMesh segments;
    for (const Border& border : borders_) {
      const int first = static_cast<int>(segments.vertices.size());
      segments.vertices.insert(segments.vertices.end(), {place(border.a), place(border.b)});
      segments.elements.emplace_back(first, first + 1, first + 1);
    }
    const Bvh tree(segments);
    const auto may_go_on = [&](std::uint32_t, std::uint32_t) { return pairs_ <= most_pairs_; };
    visitLeafPairsIf({tree, tree, Pose::Identity()}, longestReach(borders_), may_go_on, [&](std::uint32_t leaf, std::uint32_t other) {
      const Bvh::Node &first = tree.nodes()[leaf], &second = tree.nodes()[other];
      pairs_ += static_cast<std::size_t>(first.count) * second.count;
      for (std::uint32_t i = first.first; i < first.first + first.count; ++i) {
        for (std::uint32_t j = second.first; j < second.first + second.count; ++j) {
          if (tree.order()[i] < tree.order()[j]) add(tree.order()[i], tree.order()[j]);
        }
      }
    });
    if (pairs_ > most_pairs_) overlaps_.clear();
    return pairs_ <= most_pairs_;
  }

  const std::vector<Overlap>& overlaps() const { return overlaps_; }
  bool isNearest(const Overlap& o) const { return o.distance <= std::max(nearest_[o.e], nearest_[o.f]) + SAME; }

  const Vector3& place(int vertex) const { return mesh_.vertices[vertex]; }
  double distance(int vertex, const Border& border, double* parameter) const {
    const Vector3 &from = place(border.a), &to = place(border.b), &p = place(vertex);
    *parameter = nearestParameter(p, from, to);
    return (p - from - *parameter * (to - from)).norm();
  }

 private:
  void add(int i, int j) {
    const Border &e = borders_[i], &f = borders_[j];
    if (!mayContinue(e, f)) return;
    const double reach = reachOf(e, f);
    double lower = std::numeric_limits<double>::infinity(), upper = -lower, largest = 0;
    const auto covers = [&](double distance, double parameter) {
      if (distance > reach) return;
      lower = std::min(lower, parameter * e.length);
      upper = std::max(upper, parameter * e.length);
      largest = std::max(largest, distance);
    };
    double parameter, unused;
    for (const int vertex : {f.a, f.b}) {
      const double apart = distance(vertex, e, &parameter);
      covers(apart, parameter);
    }
    covers(distance(e.a, f, &unused), 0);
    covers(distance(e.b, f, &unused), 1);
    if (!(upper - lower >= MIN_OVERLAP * reach)) return;
    overlaps_.push_back({i, j, largest});
    nearest_[i] = std::min(nearest_[i], largest);
    nearest_[j] = std::min(nearest_[j], largest);
  }

  const TriangleMesh& mesh_;
  const std::vector<Border>& borders_;
  const std::size_t most_pairs_;
  std::size_t pairs_ = 0;
  std::vector<double> nearest_;
  std::vector<Overlap> overlaps_;
};

/** Joins and splits that overlaps ask for. */
class OverlapJoiner {
 public:
  OverlapJoiner(const TriangleMesh& mesh, const OverlapFinder& finder, const MeshTopology& topology, VertexClusters* clusters)
      : mesh_(mesh), finder_(finder), topology_(topology), clusters_(*clusters) {}

  /** A vertex that lies on a border is joined with its end, or splits it; else nothing. @return joined */
  bool lay(int vertex, const Border& border, double reach) {
    double parameter;
    if (vertex == border.a || vertex == border.b || finder_.distance(vertex, border, &parameter) > reach) return false;
    for (const int end : {border.a, border.b}) {
      const double apart = (finder_.place(vertex) - finder_.place(end)).norm();
      if (apart > reach || areNeighbours(mesh_, topology_, vertex, end)) continue;
      clusters_.join(vertex, end);
      return true;
    }
    if (parameter > 0 && parameter < 1) splits.push_back({border.face, border.side, vertex});
    return false;
  }

  std::vector<EdgeSplit> splits;

 private:
  const TriangleMesh& mesh_;
  const OverlapFinder& finder_;
  const MeshTopology& topology_;
  VertexClusters& clusters_;
};

/** Cuts one triangle. */
class TriangleCutter {
 public:
  TriangleCutter(const std::vector<Vector3>& vertices, std::vector<Vector3i>* out) : vertices_(vertices), out_(*out) {}

  /** @param cuts per side, the vertices on it from its first corner to its second */
  void cut(const Vector3i& corners, const std::array<std::vector<int>, 3>& cuts) {
    const int side = longestCutSide(corners, cuts);
    if (side < 0) {
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) out_.push_back(corners);
      return;
    }
    const int next = (side + 1) % 3, last = (side + 2) % 3, apex = corners[last];
    const std::vector<int>& chain = cuts[side];
    cut({corners[side], chain.front(), apex}, {{{}, {}, cuts[last]}});
    for (std::size_t i = 1; i < chain.size(); ++i) cut({chain[i - 1], chain[i], apex}, {});
    cut({chain.back(), corners[next], apex}, {{{}, cuts[next], {}}});
  }

 private:
  /** The longest side that is cut, -1 if none is; among equally long ones that whose opposite corner has the largest x, then y, then z. */
  int longestCutSide(const Vector3i& corners, const std::array<std::vector<int>, 3>& cuts) const {
    int longest = -1;
    const auto rank = [&](int side) {
      const Vector3 &a = vertices_[corners[side]], &b = vertices_[corners[(side + 1) % 3]], &c = vertices_[corners[(side + 2) % 3]];
      return std::make_tuple((b - a).squaredNorm(), c.x(), c.y(), c.z());
    };
    for (int side = 0; side < 3; ++side) {
      if (!cuts[side].empty() && (longest < 0 || rank(side) > rank(longest))) longest = side;
    }
    return longest;
  }

  const std::vector<Vector3>& vertices_;
  std::vector<Vector3i>& out_;
};

}  // namespace

std::vector<EdgeSplit> joinOverlapping(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<Border>& borders,
                                       VertexClusters* clusters, MeshMending* what) {
  if (borders.empty()) return {};
  OverlapFinder finder(mesh, borders);
  what->given_up = !finder.find();
  OverlapJoiner joiner(mesh, finder, topology, clusters);
  for (const Overlap& overlap : finder.overlaps()) {
    if (!finder.isNearest(overlap)) continue;
    const Border &e = borders[overlap.e], &f = borders[overlap.f];
    const double reach = reachOf(e, f);
    const std::size_t splits = joiner.splits.size();
    bool joined = false;
    for (const int vertex : {f.a, f.b}) joined = joiner.lay(vertex, e, reach) || joined;
    for (const int vertex : {e.a, e.b}) joined = joiner.lay(vertex, f, reach) || joined;
    what->cracks += joined;
    if (joined || splits < joiner.splits.size()) what->widest_crack = std::max(what->widest_crack, overlap.distance);
  }
  return joiner.splits;
}

TriangleMesh splitMesh(const TriangleMesh& mesh, std::vector<EdgeSplit> splits, MeshMending* what) {
  const auto order = [&](const EdgeSplit& split) {
    const Vector3i& corners = mesh.elements[split.face];
    const Vector3 &from = mesh.vertices[corners[split.side]], &to = mesh.vertices[corners[(split.side + 1) % 3]];
    return std::make_tuple(split.face, split.side, (mesh.vertices[split.vertex] - from).dot(to - from), split.vertex);
  };
  std::sort(splits.begin(), splits.end(), [&](const EdgeSplit& a, const EdgeSplit& b) { return order(a) < order(b); });
  TriangleMesh result;
  result.vertices = mesh.vertices;
  result.elements.reserve(mesh.elements.size() + splits.size());
  TriangleCutter cutter(result.vertices, &result.elements);
  std::size_t next = 0;
  for (int face = 0; face < static_cast<int>(mesh.elements.size()); ++face) {
    const Vector3i& corners = mesh.elements[face];
    std::array<std::vector<int>, 3> cuts;
    for (; next < splits.size() && splits[next].face == face; ++next) {
      std::vector<int>& cut = cuts[splits[next].side];
      const bool is_corner = (corners.array() == splits[next].vertex).any();
      if (!is_corner && (cut.empty() || cut.back() != splits[next].vertex)) cut.push_back(splits[next].vertex);
    }
    for (const std::vector<int>& cut : cuts) what->split_edges += !cut.empty();
    if (cuts[0].empty() && cuts[1].empty() && cuts[2].empty()) {
      result.elements.push_back(corners);
    } else {
      cutter.cut(corners, cuts);
    }
  }
  return result;
}

}  // namespace blem_sim::geometry
