#include "blem_sim/contact/broad_phase.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "blem_sim/geometry/for_all.h"

namespace blem_sim::contact {
namespace {

constexpr std::size_t SWEPT_AT_ONCE = 64;      // boxes: so few need no cells
constexpr double CELL_OF_BOX = 2;              // cells are so many times as wide as the median box
constexpr std::size_t SWEPT_IN_A_PIECE = 256;  // entries of boxes in cells, which a thread sweeps at once: some ten microseconds
constexpr int LARGE = 16;                      // cells that a box may cover

Vector3 halfExtents(const Box& box) { return 0.5 * (box.max() - box.min()); }

/** Box around the turned box. */
void turnBox(const Box& box, const Pose& X_WC, Vector3* lower, Vector3* upper) {
  const Vector3 half = X_WC.linear().cwiseAbs() * halfExtents(box), centre = X_WC * box.center();
  *lower = centre - half;
  *upper = centre + half;
}

/** Smallest signed distance [m] from the half-space's plane to the box of another collider; negative below it. */
double boxAbovePlane(const CollisionGeometry& half_space, const Pose& X_WH, const Box& box, const Pose& X_WC) {
  const Vector3 normal_W = X_WH.linear() * half_space.planeNormal();
  const double offset_W = half_space.planeOffset() + normal_W.dot(X_WH.translation());
  const Vector3 normal_C = X_WC.linear().transpose() * normal_W;
  return normal_W.dot(X_WC * box.center()) - normal_C.cwiseAbs().dot(halfExtents(box)) - offset_W;
}

}  // namespace

class BroadPhase::Search {
 public:
  /** As BroadPhase::find has it. */
  struct Question {
    const std::vector<Collider>& colliders;
    const std::vector<ColliderMotion>& motion;
    const CollisionFilter& filter;
    double base_margin, max_margin;
  };

  Search(const Question& asked, BroadPhase* space)
      : space_(*space),
        colliders_(asked.colliders),
        motion_(asked.motion),
        filter_(asked.filter),
        base_margin_(asked.base_margin),
        max_margin_(asked.max_margin) {}

  void run() {
    space_.half_spaces_.clear();
    space_.boxes_.clear();
    clear(&space_.all_);
    for (int i = 0; i < static_cast<int>(colliders_.size()); ++i) {
      if (colliders_[i].enabled && colliders_[i].geometry) enter(i);
    }
    for (const int half_space : space_.half_spaces_) {
      for (const SweepBox& box : space_.boxes_) meetHalfSpace(half_space, box);
    }
    if (space_.boxes_.size() < SWEPT_AT_ONCE) {
      sortStarts(spread(0));
      sweep();
    } else {
      sweepCells();
    }
    std::sort(space_.all_.pairs.begin(), space_.all_.pairs.end(),
              [](const ColliderPair& p, const ColliderPair& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
  }

 private:
  void enter(int i) {
    if (colliders_[i].geometry->isHalfSpace()) {
      space_.half_spaces_.push_back(i);
      return;
    }
    const int model = colliders_[i].model >= 0 && !filter_.selfCollides(colliders_[i].model) ? colliders_[i].model : -1;
    SweepBox box{i, model, {}, {}, colliders_[i].radius + std::min(max_margin_, std::max(0.5 * base_margin_, motion_[i].reach))};
    turnBox(colliders_[i].geometry->bounds(), motion_[i].X_WC, &box.lower, &box.upper);
    // A state that is not finite is the step's to report; here it would only upset the order.
    if (box.lower.allFinite() && box.upper.allFinite()) space_.boxes_.push_back(box);
  }

  double margin(int i, int j) const { return std::min(max_margin_, std::max(base_margin_, motion_[i].reach + motion_[j].reach)); }

  /** Furthest distance [m] at which the pair matters. */
  double range(int i, int j) const { return colliders_[i].radius + colliders_[j].radius + margin(i, j); }

  static void clear(Found* found) {
    found->pairs.clear();
    found->compared = 0;
  }

  void add(int i, int j, Found* found) const { found->pairs.push_back({std::min(i, j), std::max(i, j), margin(i, j)}); }

  void meetHalfSpace(int half_space, const SweepBox& box) {
    const int i = box.collider;
    if (!filter_.allows(colliders_[half_space], colliders_[i])) return;
    const double height =
        boxAbovePlane(*colliders_[half_space].geometry, motion_[half_space].X_WC, colliders_[i].geometry->bounds(), motion_[i].X_WC);
    if (height <= range(half_space, i)) add(half_space, i, &space_.all_);
  }

  /** The axis along which the boxes' centres are spread most, if rank is 0; that of the next spread, if it is 1, 2. */
  int spread(int rank) const {
    Vector3 sum = Vector3::Zero(), sum_of_squares = Vector3::Zero();
    for (const SweepBox& box : space_.boxes_) {
      const Vector3 centre = 0.5 * (box.lower + box.upper);
      sum += centre;
      sum_of_squares += centre.cwiseAbs2();
    }
    const Vector3 spread = sum_of_squares - sum.cwiseAbs2() / std::max<double>(1, space_.boxes_.size());
    int axes[] = {0, 1, 2};
    std::sort(axes, axes + 3, [&](int a, int b) { return spread[a] > spread[b] || (spread[a] == spread[b] && a < b); });
    return axes[rank];
  }

  static double begin(const SweepBox& box, int axis) { return box.lower[axis] - box.reach; }
  static double end(const SweepBox& box, int axis) { return box.upper[axis] + box.reach; }

  void sortStarts(int axis) {
    axis_ = axis;
    std::vector<SweepStart>& starts = space_.starts_;
    starts.clear();
    for (std::size_t i = 0; i < space_.boxes_.size(); ++i)
      starts.push_back({begin(space_.boxes_[i], axis), static_cast<int>(i), space_.boxes_[i].model});
    // Boxes are in the order of their colliders.
    std::sort(starts.begin(), starts.end(),
              [](const SweepStart& p, const SweepStart& q) { return p.at < q.at || (p.at == q.at && p.box < q.box); });
  }

  void sweep() {
    const std::vector<SweepStart>& starts = space_.starts_;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const SweepBox& box = space_.boxes_[starts[i].box];
      const double to = end(box, axis_);
      for (std::size_t j = i + 1; j < starts.size() && starts[j].at <= to; ++j) meetStart(box, starts[j]);
    }
  }

  void meetStart(const SweepBox& box, const SweepStart& other) {
    if (box.model < 0 || other.model != box.model) meet(box, space_.boxes_[other.box], &space_.all_);
  }

  // Boxes beside each other along two axes are never compared; those of many cells are, with all boxes that overlap them along one axis.
  void sweepCells() {
    for (int i = 0; i < 2; ++i) {
      cell_axes_[i] = spread(i);
      widths_[i] = CELL_OF_BOX * medianSize(cell_axes_[i]);
    }
    axis_ = spread(2);
    space_.large_.assign(space_.boxes_.size(), 0);
    space_.entries_.clear();
    space_.entries_.reserve(4 * space_.boxes_.size());
    bool some_large = false;
    for (std::size_t i = 0; i < space_.boxes_.size(); ++i) some_large |= !enterCells(static_cast<int>(i));
    if (some_large) sweepLarge();
    std::vector<CellEntry>& entries = space_.entries_;
    std::sort(entries.begin(), entries.end(),
              [](const CellEntry& p, const CellEntry& q) { return std::tie(p.cell, p.at, p.box) < std::tie(q.cell, q.at, q.box); });
    sweepPieces();
  }

  // Threads share the pieces; which one finds a pair shows nowhere, since pairs are sorted in the end.
  void sweepPieces() {
    const std::size_t entries = space_.entries_.size(), pieces = (entries + SWEPT_IN_A_PIECE - 1) / SWEPT_IN_A_PIECE;
    if (space_.found_.size() < pieces) space_.found_.resize(pieces);
    const auto sweepPiece = [&](std::size_t piece) {
      Found* found = &space_.found_[piece];
      clear(found);
      sweepEntries(piece * SWEPT_IN_A_PIECE, std::min(entries, (piece + 1) * SWEPT_IN_A_PIECE), found);
    };
    if (tbb::this_task_arena::max_concurrency() == 1)
      for (std::size_t piece = 0; piece < pieces; ++piece) sweepPiece(piece);
    else
      geometry::forAll(pieces, sweepPiece, 1);
    for (std::size_t piece = 0; piece < pieces; ++piece) {
      const Found& found = space_.found_[piece];
      space_.all_.pairs.insert(space_.all_.pairs.end(), found.pairs.begin(), found.pairs.end());
      space_.all_.compared += found.compared;
    }
  }

  void sweepEntries(std::size_t first, std::size_t last, Found* found) const {
    const std::vector<CellEntry>& entries = space_.entries_;
    for (std::size_t i = first; i < last; ++i) {
      const SweepBox& box = space_.boxes_[entries[i].box];
      const double to = end(box, axis_);
      for (std::size_t j = i + 1; j < entries.size() && entries[j].cell == entries[i].cell && entries[j].at <= to; ++j) {
        const SweepBox& other = space_.boxes_[entries[j].box];
        if ((box.model < 0 || other.model != box.model) && firstCommonCell(box, other) == entries[i].cell) meet(box, other, found);
      }
    }
  }

  double medianSize(int axis) {
    std::vector<double>& sizes = space_.sizes_;
    sizes.clear();
    for (const SweepBox& box : space_.boxes_) sizes.push_back(end(box, axis) - begin(box, axis));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return *middle;
  }

  /** Cell of a place, monotonic in it; places beyond the last cell are in that one. */
  std::int64_t cellAt(double place, int i) const {
    constexpr double LAST = 1e9;
    return static_cast<std::int64_t>(std::floor(std::clamp(place / widths_[i], -LAST, LAST)));
  }

  static std::uint64_t cellOf(std::int64_t first, std::int64_t second) {
    return (static_cast<std::uint64_t>(first) << 32) ^ (static_cast<std::uint64_t>(second) & 0xffffffffu);
  }

  /** Two boxes that share several cells are a pair in one of them only. */
  std::uint64_t firstCommonCell(const SweepBox& box, const SweepBox& other) const {
    const auto first = [&](int i) { return cellAt(std::max(begin(box, cell_axes_[i]), begin(other, cell_axes_[i])), i); };
    return cellOf(first(0), first(1));
  }

  /** Enters a box into its cells. @return false for a box of too many cells, or where cells have no width */
  bool enterCells(int i) {
    const SweepBox& box = space_.boxes_[i];
    std::int64_t first[2], last[2];
    for (int k = 0; k < 2; ++k) {
      if (!(widths_[k] > 0)) return !(space_.large_[i] = 1);
      first[k] = cellAt(begin(box, cell_axes_[k]), k);
      last[k] = cellAt(end(box, cell_axes_[k]), k);
    }
    if ((last[0] - first[0] + 1) * (last[1] - first[1] + 1) > LARGE) return !(space_.large_[i] = 1);
    for (std::int64_t x = first[0]; x <= last[0]; ++x)
      for (std::int64_t y = first[1]; y <= last[1]; ++y) space_.entries_.push_back({cellOf(x, y), begin(box, axis_), i});
    return true;
  }

  // Compares each large box with all that start after it, each other one with the large ones that do.
  void sweepLarge() {
    const int third_axis = axis_;
    sortStarts(cell_axes_[0]);
    const std::vector<SweepStart>& starts = space_.starts_;
    std::vector<int>& large_starts = space_.large_starts_;
    large_starts.clear();
    for (std::size_t i = 0; i < starts.size(); ++i)
      if (space_.large_[starts[i].box]) large_starts.push_back(static_cast<int>(i));
    std::size_t next_large = 0;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const SweepBox& box = space_.boxes_[starts[i].box];
      const double to = end(box, axis_);
      if (space_.large_[starts[i].box]) {
        ++next_large;
        for (std::size_t j = i + 1; j < starts.size() && starts[j].at <= to; ++j) meetStart(box, starts[j]);
      } else {
        for (std::size_t j = next_large; j < large_starts.size() && starts[large_starts[j]].at <= to; ++j)
          meetStart(box, starts[large_starts[j]]);
      }
    }
    axis_ = third_axis;
  }

  void meet(const SweepBox& box, const SweepBox& other, Found* found) const {
    ++found->compared;
    const Vector3 gap = (box.lower - other.upper).cwiseMax(other.lower - box.upper).cwiseMax(0.0);
    const double furthest = range(box.collider, other.collider);
    if (gap.squaredNorm() > furthest * furthest) return;
    if (filter_.allows(colliders_[box.collider], colliders_[other.collider])) add(box.collider, other.collider, found);
  }

  BroadPhase& space_;
  const std::vector<Collider>& colliders_;
  const std::vector<ColliderMotion>& motion_;
  const CollisionFilter& filter_;
  const double base_margin_, max_margin_;
  int axis_ = 0;  // axis of the sweep
  int cell_axes_[2] = {0, 0};
  double widths_[2] = {0, 0};  // [m] of cells along their axes
};

void CollisionFilter::setSelfCollision(int model, bool on) {
  self_colliding_links_.erase(model);
  if (on) {
    self_colliding_models_.insert(model);
  } else {
    self_colliding_models_.erase(model);
  }
}

void CollisionFilter::setSelfCollidingLinks(int model, const std::set<int>& links) {
  setSelfCollision(model, !links.empty());
  if (!links.empty()) self_colliding_links_[model] = links;
}

const std::set<int>& CollisionFilter::selfCollidingLinks(int model) const {
  static const std::set<int> ALL;
  const auto some = self_colliding_links_.find(model);
  return some == self_colliding_links_.end() ? ALL : some->second;
}

void CollisionFilter::disableBodies(int body_a, int body_b) { disabled_bodies_.insert(std::minmax(body_a, body_b)); }

void CollisionFilter::forgetBody(int body) {
  for (auto pair = disabled_bodies_.begin(); pair != disabled_bodies_.end();)
    pair = pair->first == body || pair->second == body ? disabled_bodies_.erase(pair) : std::next(pair);
}

bool CollisionFilter::allows(const Collider& a, const Collider& b) const {
  if (!a.enabled || !b.enabled || a.body == b.body) return false;
  if (a.model == b.model && a.model >= 0) {
    if (!selfCollides(a.model)) return false;
    const std::set<int>& links = selfCollidingLinks(a.model);
    if (!links.empty() && links.count(a.link) == 0 && links.count(b.link) == 0) return false;
  }
  return disabled_bodies_.count(std::minmax(a.body, b.body)) == 0;
}

const std::vector<ColliderPair>& BroadPhase::find(const std::vector<Collider>& colliders, const std::vector<ColliderMotion>& motion,
                                                  const CollisionFilter& filter, double base_margin, double max_margin) {
  Search({colliders, motion, filter, base_margin, max_margin}, this).run();
  return all_.pairs;
}

}  // namespace blem_sim::contact
