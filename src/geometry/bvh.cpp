#include "blem_sim/geometry/bvh.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

namespace blem_sim {
namespace {

constexpr float INFINITE = std::numeric_limits<float>::infinity();

/** Axis-aligned float box; the fourth places are not its own. */
struct FloatBox {
  Eigen::Array4f lower, upper;

  static FloatBox nothing() { return {Eigen::Array4f::Constant(INFINITE), Eigen::Array4f::Constant(-INFINITE)}; }
  void extend(const FloatBox& other) {
    lower = lower.min(other.lower);
    upper = upper.max(other.upper);
  }
  /** Half the area, with a touch of the sides' sum, so that boxes on a line still differ. */
  float cost() const {
    const float x = upper[0] - lower[0], y = upper[1] - lower[1], z = upper[2] - lower[2];
    return x * y + y * z + z * x + 1e-4f * (x + y + z) * (x + y + z);
  }
};

/** An element during the build: its box, whose middle (doubled) sorts it, and its index, in the box's fourth places. */
class Primitive {
 public:
  void set(const Vector3& a, const Vector3& b, const Vector3& c, std::uint32_t element) {
    for (int k = 0; k < 3; ++k) {
      box_.lower[k] = roundedDown(std::min({a[k], b[k], c[k]}));
      box_.upper[k] = roundedUp(std::max({a[k], b[k], c[k]}));
    }
    box_.lower[3] = packed(element & MANTISSA);
    box_.upper[3] = packed(element >> MANTISSA_BITS);
  }

  const FloatBox& box() const { return box_; }
  Eigen::Array4f middle() const { return box_.lower + box_.upper; }
  float middle(int axis) const { return box_.lower[axis] + box_.upper[axis]; }
  std::uint32_t element() const { return unpacked(box_.lower[3]) | unpacked(box_.upper[3]) << MANTISSA_BITS; }

 private:
  static constexpr int MANTISSA_BITS = 23;
  static constexpr std::uint32_t MANTISSA = (1u << MANTISSA_BITS) - 1, ONE = 0x3f800000;

  /** A number between 1 and 2: arithmetic with any bits as a float could be slow. */
  static float packed(std::uint32_t mantissa) { return floatOf(ONE | mantissa); }
  static std::uint32_t unpacked(float x) { return bitsOf(x) & MANTISSA; }

  static float floatOf(std::uint32_t bits) {
    float x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
  }
  static std::uint32_t bitsOf(float x) {
    std::uint32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
  }
  /** std::nextafter upwards, without its call. */
  static float next(float x) {
    if (x == 0) return std::numeric_limits<float>::denorm_min();
    return floatOf(x > 0 ? bitsOf(x) + 1 : bitsOf(x) - 1);
  }
  // The sum makes -0.0 positive: of two zeros the order would tell which one a box has.
  static float roundedUp(double x) {
    const float f = static_cast<float>(x);
    return (f < x ? next(f) : f) + 0.0f;
  }
  static float roundedDown(double x) { return 0.0f - roundedUp(-x); }

  FloatBox box_;
};

std::unique_ptr<Primitive[]> primitivesOf(const TriangleMesh& mesh) {
  std::unique_ptr<Primitive[]> primitives(new Primitive[mesh.elements.size()]);
  tbb::parallel_for(std::size_t{0}, mesh.elements.size(), [&](std::size_t i) {
    const Vector3i& e = mesh.elements[i];
    primitives[i].set(mesh.vertices[e[0]], mesh.vertices[e[1]], mesh.vertices[e[2]], static_cast<std::uint32_t>(i));
  });
  return primitives;
}

/** A run of primitives that becomes a node. */
struct Run {
  Primitive *begin, *end;
  int depth;
  std::size_t size() const { return static_cast<std::size_t>(end - begin); }
};

constexpr int BINS = 16;
/** Deeper nodes are split at the median, so that no input makes a deep tree. */
constexpr int MAX_SAH_DEPTH = Bvh::MAX_DEPTH / 2;

/** Which bins a middle falls into, per axis. */
struct Binning {
  explicit Binning(const FloatBox& middles) : lower(middles.lower), scale(BINS * (1 - 1e-6f) / (middles.upper - middles.lower)) {
    for (int k = 0; k < 4; ++k) usable[k] = std::isfinite(scale[k]);
    for (int k = 0; k < 4; ++k) scale[k] = usable[k] ? scale[k] : 0;
  }
  /** To be rounded down. */
  Eigen::Array4f operator()(const Primitive& p) const { return ((p.middle() - lower) * scale).min(BINS - 1.0f); }
  int operator()(const Primitive& p, int axis) const {
    return std::min(BINS - 1, static_cast<int>((p.middle(axis) - lower[axis]) * scale[axis]));
  }

  Eigen::Array4f lower, scale;
  std::array<bool, 4> usable;
};

struct Split {
  int axis = -1;  ///< -1: none found
  int bin = 0;    ///< first bin of the right side
  float cost = INFINITE;
};

/** What lies in the bins of one axis. */
struct Bins {
  Bins() { boxes.fill(FloatBox::nothing()); }

  std::array<FloatBox, BINS> boxes;
  std::array<std::uint32_t, BINS> counts{};

  void add(int bin, const FloatBox& box) {
    boxes[bin].extend(box);
    ++counts[bin];
  }

  /** Cheapest border between bins by the surface area heuristic, if cheaper than `best`. [Wald 2007] */
  void improve(int axis, Split* best) const {
    std::array<int, BINS + 1> filled;
    int n = 0;
    for (int i = 0; i < BINS; ++i) {
      filled[n] = i;
      n += counts[i] > 0;
    }
    std::array<float, BINS> right_cost;
    FloatBox right = FloatBox::nothing(), left = right;
    std::uint32_t right_count = 0, left_count = 0;
    for (int i = n - 1; i > 0; --i) {
      right.extend(boxes[filled[i]]);
      right_count += counts[filled[i]];
      right_cost[i] = right.cost() * right_count;
    }
    for (int i = 1; i < n; ++i) {
      left.extend(boxes[filled[i - 1]]);
      left_count += counts[filled[i - 1]];
      const float cost = left.cost() * left_count + right_cost[i];
      if (cost < best->cost) *best = {axis, filled[i - 1] + 1, cost};
    }
  }
};

Split cheapestSplit(const Run& run, const Binning& binning) {
  std::array<Bins, 3> bins;
  for (const Primitive* p = run.begin; p != run.end; ++p) {
    const Eigen::Array4f bin = binning(*p);
    for (int axis = 0; axis < 3; ++axis) bins[axis].add(static_cast<int>(bin[axis]), p->box());
  }
  Split split;
  for (int axis = 0; axis < 3; ++axis) {
    if (binning.usable[axis]) bins[axis].improve(axis, &split);
  }
  return split;
}

/** Reorders the run and returns where its right side begins; both sides hold something. */
Primitive* partitioned(const Run& run, const FloatBox& middles) {
  const Binning binning(middles);
  const Split split = run.depth < MAX_SAH_DEPTH ? cheapestSplit(run, binning) : Split();
  if (split.axis >= 0) return std::partition(run.begin, run.end, [&](const Primitive& p) { return binning(p, split.axis) < split.bin; });
  // All middles in one place, or too deep: halves, in a total order.
  int widest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (middles.upper[axis] - middles.lower[axis] > middles.upper[widest] - middles.lower[widest]) widest = axis;
  }
  Primitive* middle = run.begin + run.size() / 2;
  std::nth_element(run.begin, middle, run.end, [widest](const Primitive& p, const Primitive& q) {
    return p.middle(widest) != q.middle(widest) ? p.middle(widest) < q.middle(widest) : p.element() < q.element();
  });
  return middle;
}

/** Makes the subtrees of runs, large ones by several threads; which ones does not show in the tree. */
class Builder {
 public:
  Builder(Primitive* begin, Primitive* end, int leaf_size)
      : all_{begin, end, 0}, leaf_size_(static_cast<std::size_t>(std::max(1, leaf_size))) {}

  std::vector<Bvh::Node> build() {
    const Part root = partOf(all_);
    std::vector<Bvh::Node> nodes(1 + root.below());
    place(root, 0, 1, &nodes);
    return nodes;
  }

 private:
  static constexpr std::size_t SMALL = 1 << 14;  // primitives that one thread takes at once

  /** A node and all below it: two parts, or nodes whose children are counted from the first of them. */
  struct Part {
    Bvh::Node node;
    std::vector<Bvh::Node> nodes;
    std::unique_ptr<Part> left, right;

    std::size_t below() const { return left ? 2 + left->below() + right->below() : nodes.size(); }
  };

  /** Fills in the node of a run. @return where its right side begins, null for a leaf */
  Primitive* split(const Run& run, Bvh::Node* node) const {
    FloatBox box = FloatBox::nothing(), middles = box;
    for (const Primitive* p = run.begin; p != run.end; ++p) {
      box.extend(p->box());
      const Eigen::Array4f middle = p->middle();
      middles.lower = middles.lower.min(middle);
      middles.upper = middles.upper.max(middle);
    }
    node->lower = box.lower.head<3>();
    node->upper = box.upper.head<3>();
    node->first = static_cast<std::uint32_t>(run.begin - all_.begin);
    node->count = static_cast<std::uint32_t>(run.size());
    if (run.size() <= leaf_size_) return nullptr;
    node->count = 0;
    return partitioned(run, middles);
  }

  Part partOf(const Run& run) const {
    Part part;
    if (run.size() <= SMALL) {
      buildBelow(run, &part);
      return part;
    }
    Primitive* const middle = split(run, &part.node);
    part.left = std::make_unique<Part>();
    part.right = std::make_unique<Part>();
    tbb::parallel_invoke(
        [&] {
          *part.left = partOf({run.begin, middle, run.depth + 1});
        },
        [&] {
          *part.right = partOf({middle, run.end, run.depth + 1});
        });
    return part;
  }

  /** Children come before those of their right neighbours, pair by pair. */
  void buildBelow(const Run& all, Part* part) const {
    constexpr std::size_t ROOT = static_cast<std::size_t>(-1);
    struct Task {
      Run run;
      std::size_t node;
    };
    std::vector<Bvh::Node>& nodes = part->nodes;
    nodes.reserve(all.size());
    std::vector<Task> tasks = {{all, ROOT}};
    while (!tasks.empty()) {
      const auto [run, index] = tasks.back();
      tasks.pop_back();
      Bvh::Node& node = index == ROOT ? part->node : nodes[index];
      Primitive* const middle = split(run, &node);
      if (!middle) continue;
      const std::size_t left = nodes.size();
      node.first = static_cast<std::uint32_t>(left);
      nodes.resize(left + 2);
      tasks.push_back({{middle, run.end, run.depth + 1}, left + 1});
      tasks.push_back({{run.begin, middle, run.depth + 1}, left});
    }
  }

  /** Writes a part's node to `index` and what is below to `below` and on. */
  static void place(const Part& part, std::size_t index, std::size_t below, std::vector<Bvh::Node>* nodes) {
    const auto placed = [below](Bvh::Node node) {
      if (!node.isLeaf()) node.first += static_cast<std::uint32_t>(below);
      return node;
    };
    Bvh::Node& node = (*nodes)[index] = part.node;
    if (!part.left) {
      node = placed(node);
      std::transform(part.nodes.begin(), part.nodes.end(), nodes->begin() + static_cast<std::ptrdiff_t>(below), placed);
      return;
    }
    node.first = static_cast<std::uint32_t>(below);
    tbb::parallel_invoke([&] { place(*part.left, below, below + 2, nodes); },
                         [&] { place(*part.right, below + 1, below + 2 + part.left->below(), nodes); });
  }

  const Run all_;
  const std::size_t leaf_size_;
};

}  // namespace

Bvh::Bvh(const TriangleMesh& mesh, int leaf_size) {
  if (mesh.elements.empty()) return;
  const std::unique_ptr<Primitive[]> primitives = primitivesOf(mesh);
  nodes_ = Builder(primitives.get(), primitives.get() + mesh.elements.size(), leaf_size).build();
  order_.resize(mesh.elements.size());
  tbb::parallel_for(std::size_t{0}, order_.size(), [&](std::size_t i) { order_[i] = primitives[i].element(); });
}

}  // namespace blem_sim
