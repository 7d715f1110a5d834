#include "blem_sim/geometry/bvh.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <memory>

#include "blem_sim/geometry/for_all.h"
#include "bvh_split.h"

namespace blem_sim::geometry {
namespace {

std::unique_ptr<Primitive[]> primitivesOf(const TriangleMesh& mesh) {
  std::unique_ptr<Primitive[]> primitives(new Primitive[mesh.elements.size()]);
  forAll(mesh.elements.size(), [&](std::size_t i) {
    const Vector3i& e = mesh.elements[i];
    primitives[i].set(mesh.vertices[e[0]], mesh.vertices[e[1]], mesh.vertices[e[2]], static_cast<std::uint32_t>(i));
  });
  return primitives;
}

/** Makes the subtrees of runs, large ones by several threads; which ones does not show in the tree. */
class Builder {
  struct Part;

 public:
  Builder(Primitive* begin, Primitive* end, int leaf_size, SplitBy by)
      : all_(boundedRun(begin, end)), leaf_size_(static_cast<std::size_t>(std::max(1, leaf_size))), by_(by) {}

  /** Puts the primitives into the tree's order. */
  Part build() const { return partOf({all_, 0}); }

  /** The tree whose root that is; needs no primitives. */
  static std::vector<Bvh::Node> nodesOf(const Part& root) {
    std::vector<Bvh::Node> nodes(1 + root.below());
    place(root, 0, 1, &nodes);
    return nodes;
  }

 private:
  /** Deeper nodes are split at the median, so that no input makes a deep tree. */
  static constexpr int MAX_CHOSEN_DEPTH = Bvh::MAX_DEPTH / 2;

  struct Run : PrimitiveRun {
    Run() = default;
    Run(const PrimitiveRun& run, int depth_of_run) : PrimitiveRun(run), depth(depth_of_run) {}
    int depth = 0;
  };
  static constexpr std::size_t SMALL = 1 << 14;  // primitives that one thread takes at once

  /** A node and all below it: two parts, or nodes whose children are counted from the first of them. */
  struct Part {
    Bvh::Node node;
    std::vector<Bvh::Node> nodes;
    std::unique_ptr<Part> left, right;

    std::size_t below() const { return left ? 2 + left->below() + right->below() : nodes.size(); }
  };

  /** Fills in the node of a run. @return false for a leaf; else the run lies in its two sides */
  bool split(const Run& run, Bvh::Node* node, Run* left, Run* right) const {
    const BuildBox& box = run.bounds.box;
    node->lower = {box.lower[0], box.lower[1], box.lower[2]};
    node->upper = {box.upper[0], box.upper[1], box.upper[2]};
    node->first = static_cast<std::uint32_t>(run.begin - all_.begin);
    node->count = static_cast<std::uint32_t>(run.size());
    if (run.size() <= leaf_size_) return false;
    node->count = 0;
    splitRun(run, run.depth < MAX_CHOSEN_DEPTH ? by_ : SplitBy::MEDIAN, left, right);
    left->depth = right->depth = run.depth + 1;
    return true;
  }

  Part partOf(const Run& run) const {
    Part part;
    if (run.size() <= std::max(SMALL, leaf_size_)) {
      buildBelow(run, &part);
      return part;
    }
    Run left, right;
    split(run, &part.node, &left, &right);
    part.left = std::make_unique<Part>();
    part.right = std::make_unique<Part>();
    tbb::parallel_invoke([&] { *part.left = partOf(left); }, [&] { *part.right = partOf(right); });
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
      Run left_run, right_run;
      if (!split(run, &node, &left_run, &right_run)) continue;
      const std::size_t left = nodes.size();
      node.first = static_cast<std::uint32_t>(left);
      nodes.resize(left + 2);
      tasks.push_back({right_run, left + 1});
      tasks.push_back({left_run, left});
    }
  }

  /** Writes a part's node to `index` and the nodes below it to `below` and on. */
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

  const PrimitiveRun all_;
  const std::size_t leaf_size_;
  const SplitBy by_;
};

}  // namespace

Bvh::Bvh(const TriangleMesh& mesh, int leaf_size) {
  if (mesh.elements.empty()) return;
  std::unique_ptr<Primitive[]> primitives = primitivesOf(mesh);
  const bool only_points =
      std::all_of(mesh.elements.begin(), mesh.elements.end(), [](const Vector3i& e) { return e[0] == e[1] && e[1] == e[2]; });
  const SplitBy by = only_points ? SplitBy::MIDDLE : SplitBy::COST;
  const auto root = Builder(primitives.get(), primitives.get() + mesh.elements.size(), leaf_size, by).build();
  order_.resize(mesh.elements.size());
  forAll(order_.size(), [&](std::size_t i) { order_[i] = primitives[i].element(); });
  primitives.reset();  // before the nodes take memory a second time
  nodes_ = Builder::nodesOf(root);
}

}  // namespace blem_sim::geometry
