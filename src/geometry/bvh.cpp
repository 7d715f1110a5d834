#include "blem_sim/geometry/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace blem_sim {
namespace {

/** Axis-aligned float box; plain arrays, since the build lives in these few loops. */
struct FloatBox {
  float lower[3] = {INFINITE, INFINITE, INFINITE};
  float upper[3] = {-INFINITE, -INFINITE, -INFINITE};

  void extend(const FloatBox& other) {
    for (int k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], other.lower[k]);
      upper[k] = std::max(upper[k], other.upper[k]);
    }
  }
  /** Half the area, with a touch of the sides' sum, so that boxes on a line still differ. */
  float cost() const {
    const float x = upper[0] - lower[0], y = upper[1] - lower[1], z = upper[2] - lower[2];
    return x * y + y * z + z * x + 1e-4f * (x + y + z) * (x + y + z);
  }

  static constexpr float INFINITE = std::numeric_limits<float>::infinity();
};

/** An element during the build: its box, whose middle (doubled) sorts it, and its index. */
struct Primitive {
  FloatBox box;
  std::uint32_t element;
  float middle(int axis) const { return box.lower[axis] + box.upper[axis]; }
};

float roundedDown(double x) {
  const float f = static_cast<float>(x);
  return f > x ? std::nextafter(f, -FloatBox::INFINITE) : f;
}
float roundedUp(double x) {
  const float f = static_cast<float>(x);
  return f < x ? std::nextafter(f, FloatBox::INFINITE) : f;
}

std::vector<Primitive> primitivesOf(const TriangleMesh& mesh) {
  std::vector<Primitive> primitives(mesh.elements.size());
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    const Vector3i& e = mesh.elements[i];
    const Vector3 &a = mesh.vertices[e[0]], &b = mesh.vertices[e[1]], &c = mesh.vertices[e[2]];
    primitives[i].element = static_cast<std::uint32_t>(i);
    for (int k = 0; k < 3; ++k) {
      primitives[i].box.lower[k] = roundedDown(std::min({a[k], b[k], c[k]}));
      primitives[i].box.upper[k] = roundedUp(std::max({a[k], b[k], c[k]}));
    }
  }
  return primitives;
}

/** A run of primitives that becomes a node. */
struct Run {
  std::uint32_t node, begin, end;
  int depth;
};

constexpr int BINS = 16;
/** Deeper nodes are split at the median, so that no input makes a deep tree. */
constexpr int MAX_SAH_DEPTH = Bvh::MAX_DEPTH / 2;

struct Bounds {
  FloatBox box;      ///< of the primitives
  FloatBox middles;  ///< of their middles
};

Bounds boundsOf(const Primitive* begin, const Primitive* end) {
  Bounds bounds;
  for (const Primitive* p = begin; p != end; ++p) {
    bounds.box.extend(p->box);
    for (int k = 0; k < 3; ++k) {
      bounds.middles.lower[k] = std::min(bounds.middles.lower[k], p->middle(k));
      bounds.middles.upper[k] = std::max(bounds.middles.upper[k], p->middle(k));
    }
  }
  return bounds;
}

/** Which bin a middle falls into. */
struct Binning {
  Binning(const FloatBox& middles, int split_axis)
      : axis(split_axis), lower(middles.lower[axis]), scale(BINS * (1 - 1e-6f) / (middles.upper[axis] - lower)) {}
  bool usable() const { return std::isfinite(scale); }
  int operator()(const Primitive& p) const { return std::min(BINS - 1, static_cast<int>((p.middle(axis) - lower) * scale)); }

  int axis;
  float lower, scale;
};

struct Split {
  int axis = -1;  ///< -1: none found
  int bin = 0;    ///< first bin of the right side
  float cost = FloatBox::INFINITE;
};

/** Cheapest border between bins of one axis by the surface area heuristic, if cheaper than `best`. [Wald 2007] */
void improveSplit(const Primitive* begin, const Primitive* end, const Binning& binning, Split* best) {
  std::array<FloatBox, BINS> boxes;
  std::array<std::uint32_t, BINS> counts{};
  for (const Primitive* p = begin; p != end; ++p) {
    const int bin = binning(*p);
    boxes[bin].extend(p->box);
    ++counts[bin];
  }
  std::array<float, BINS> right_cost{};
  FloatBox right;
  std::uint32_t right_count = 0;
  for (int i = BINS - 1; i > 0; --i) {
    right.extend(boxes[i]);
    right_count += counts[i];
    right_cost[i] = right_count > 0 ? right.cost() * right_count : FloatBox::INFINITE;
  }
  FloatBox left;
  std::uint32_t left_count = 0;
  for (int i = 1; i < BINS; ++i) {
    left.extend(boxes[i - 1]);
    left_count += counts[i - 1];
    if (left_count == 0) continue;
    const float cost = left.cost() * left_count + right_cost[i];
    if (cost < best->cost) *best = {binning.axis, i, cost};
  }
}

/** Reorders the run and returns where its right side begins; both sides hold something. */
Primitive* partitioned(Primitive* begin, Primitive* end, const FloatBox& middles, int depth) {
  Split split;
  int widest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (middles.upper[axis] - middles.lower[axis] > middles.upper[widest] - middles.lower[widest]) widest = axis;
    const Binning binning(middles, axis);
    if (depth < MAX_SAH_DEPTH && binning.usable()) improveSplit(begin, end, binning, &split);
  }
  if (split.axis >= 0) {
    const Binning binning(middles, split.axis);
    return std::partition(begin, end, [&](const Primitive& p) { return binning(p) < split.bin; });
  }
  // All middles in one place, or too deep: halves, in a total order.
  Primitive* middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end, [widest](const Primitive& p, const Primitive& q) {
    return p.middle(widest) != q.middle(widest) ? p.middle(widest) < q.middle(widest) : p.element < q.element;
  });
  return middle;
}

}  // namespace

Bvh::Bvh(const TriangleMesh& mesh, int leaf_size) {
  if (mesh.elements.empty()) return;
  std::vector<Primitive> primitives = primitivesOf(mesh);
  nodes_.reserve(2 * primitives.size());
  nodes_.emplace_back();
  std::vector<Run> runs = {{0, 0, static_cast<std::uint32_t>(primitives.size()), 0}};
  while (!runs.empty()) {
    const Run run = runs.back();
    runs.pop_back();
    Primitive* const begin = primitives.data() + run.begin;
    Primitive* const end = primitives.data() + run.end;
    const Bounds bounds = boundsOf(begin, end);
    Node& node = nodes_[run.node];
    node.lower = Eigen::Map<const Eigen::Vector3f>(bounds.box.lower);
    node.upper = Eigen::Map<const Eigen::Vector3f>(bounds.box.upper);
    node.count = run.end - run.begin;
    node.first = run.begin;
    if (node.count <= static_cast<std::uint32_t>(std::max(1, leaf_size))) continue;
    const auto middle = static_cast<std::uint32_t>(partitioned(begin, end, bounds.middles, run.depth) - primitives.data());
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    node.first = left;
    node.count = 0;
    nodes_.resize(nodes_.size() + 2);
    runs.push_back({left + 1, middle, run.end, run.depth + 1});
    runs.push_back({left, run.begin, middle, run.depth + 1});
  }
  nodes_.shrink_to_fit();
  order_.reserve(primitives.size());
  for (const Primitive& p : primitives) order_.push_back(p.element);
}

}  // namespace blem_sim
