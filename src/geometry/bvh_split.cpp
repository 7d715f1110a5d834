#include "bvh_split.h"

#include <tbb/blocked_range.h>

#include <array>
#include <cmath>

#include "blem_sim/geometry/for_all.h"

namespace blem_sim::geometry {
namespace {

using Ints = int __attribute__((vector_size(16)));

constexpr int BINS = 16;
constexpr std::size_t SOME = 512, MANY = 1 << 16;  // primitives that are binned by turns, by several threads

/** Bins that a primitive's middle falls into, per axis. */
struct Binning {
  explicit Binning(const BuildBox& middles) : lower(middles.lower), scale(BINS * (1 - 1e-6f) / (middles.upper - middles.lower)) {
    for (int k = 0; k < 4; ++k) {
      usable[k] = std::isfinite(scale[k]);
      if (!usable[k]) scale[k] = 0;
    }
  }
  Ints operator()(const Primitive& p) const {
    const Floats bin = (p.middle() - lower) * scale, last = Floats{} + (BINS - 1.0f);
    return __builtin_convertvector(bin < last ? bin : last, Ints);
  }

  Floats lower, scale;
  std::array<bool, 4> usable;
};

/** Boxes and numbers of the primitives in the bins of the three axes; lanes of numbers are axes. */
struct Bins {
  Bins() {
    for (auto& of_axis : boxes) of_axis.fill(BuildBox::nothing());
  }
  void add(const Ints& bin, const BuildBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
      boxes[axis][bin[axis]].extend(box);
      ++counts[bin[axis]][axis];
    }
  }
  void add(const Bins& other) {
    for (int bin = 0; bin < BINS; ++bin) {
      for (int axis = 0; axis < 3; ++axis) boxes[axis][bin].extend(other.boxes[axis][bin]);
      counts[bin] += other.counts[bin];
    }
  }

  std::array<std::array<BuildBox, BINS>, 3> boxes;
  std::array<Ints, BINS> counts{};
};

/** One side of borders between bins of each axis, while they move on. */
struct Sides {
  std::array<BuildBox, 3> boxes{BuildBox::nothing(), BuildBox::nothing(), BuildBox::nothing()};
  Ints counts{};

  void add(const Bins& bins, int bin) {
    for (int axis = 0; axis < 3; ++axis) boxes[axis].extend(bins.boxes[axis][bin]);
    counts += bins.counts[bin];
  }
  /** Per axis: half the box's area, with a touch of the sides' sum, so that boxes on a line still differ; times the count. NaN if empty. */
  Floats costs() const {
    const Floats a = boxes[0].upper - boxes[0].lower, b = boxes[1].upper - boxes[1].lower, c = boxes[2].upper - boxes[2].lower;
    const Floats x{a[0], b[0], c[0], 0}, y{a[1], b[1], c[1], 0}, z{a[2], b[2], c[2], 0};
    const Floats areas = x * y + y * z + z * x + 1e-4f * (x + y + z) * (x + y + z);
    return areas * __builtin_convertvector(counts, Floats);
  }
};

struct Split {
  int axis = -1;  ///< -1: none found
  int bin = 0;    ///< first bin of the right side
};

/** Cheapest border between bins; of equal ones the first. An empty side's cost, not a number, is never cheaper. */
Split cheapestSplit(const Bins& bins, const Binning& binning) {
  std::array<Floats, BINS> right_costs;
  Sides right, left;
  for (int bin = BINS - 1; bin > 0; --bin) {
    right.add(bins, bin);
    right_costs[bin] = right.costs();
  }
  Floats least = Floats{} + std::numeric_limits<float>::infinity();
  Ints cheapest{};
  for (int bin = 1; bin < BINS; ++bin) {
    left.add(bins, bin - 1);
    const Floats costs = left.costs() + right_costs[bin];
    cheapest = costs < least ? Ints{} + bin : cheapest;
    least = costs < least ? costs : least;
  }
  Split split;
  float cost = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (!binning.usable[axis] || !(least[axis] < cost)) continue;
    cost = least[axis];
    split = {axis, cheapest[axis]};
  }
  return split;
}

void addAll(const Primitive* begin, const Primitive* end, const Binning& binning, Bins* bins) {
  for (const Primitive* p = begin; p != end; ++p) bins->add(binning(*p), p->box());
}

/** Neighbours often share a bin, which then waits for itself; so every other one goes elsewhere first. */
void addAllByTurns(const Primitive* begin, const Primitive* end, const Binning& binning, Bins* bins) {
  Bins odd;
  const Primitive* p = begin;
  for (; end - p >= 2; p += 2) {
    bins->add(binning(p[0]), p[0].box());
    odd.add(binning(p[1]), p[1].box());
  }
  addAll(p, end, binning, bins);
  bins->add(odd);
}

void addByThreads(const PrimitiveRun& run, const Binning& binning, Bins* bins) {
  *bins = sumOfParts(
      tbb::blocked_range<const Primitive*>(run.begin, run.end, MANY / 4), *bins,
      [&](const tbb::blocked_range<const Primitive*>& range, Bins sum) {
        addAllByTurns(range.begin(), range.end(), binning, &sum);
        return sum;
      },
      [](Bins sum, const Bins& other) {
        sum.add(other);
        return sum;
      });
}

Split splitByCost(const PrimitiveRun& run, const Binning& binning) {
  Bins bins;
  if (run.size() >= MANY) {
    addByThreads(run, binning, &bins);
  } else if (run.size() >= SOME) {
    addAllByTurns(run.begin, run.end, binning, &bins);
  } else {
    addAll(run.begin, run.end, binning, &bins);
  }
  return cheapestSplit(bins, binning);
}

/** std::partition by `isLeft`, with the bounds of both sides. */
template <typename IsLeft>
void partition(const PrimitiveRun& run, IsLeft&& isLeft, PrimitiveRun* left_side, PrimitiveRun* right_side) {
  Primitive *first = run.begin, *last = run.end;
  RunBounds left, right;
  while (true) {
    for (; first != last && isLeft(*first); ++first) left.extend(*first);
    if (first == last) break;
    right.extend(*first);
    for (--last; first != last && !isLeft(*last); --last) right.extend(*last);
    if (first == last) break;
    left.extend(*last);
    std::swap(*first, *last);
    ++first;
  }
  *left_side = {run.begin, first, left};
  *right_side = {first, run.end, right};
}

RunBounds boundsOf(const Primitive* begin, const Primitive* end) {
  RunBounds bounds;
  for (const Primitive* p = begin; p != end; ++p) bounds.extend(*p);
  return bounds;
}

/** Axis along which middles are spread most. */
int widestAxis(const PrimitiveRun& run) {
  const BuildBox& middles = run.bounds.middles;
  int widest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (middles.upper[axis] - middles.lower[axis] > middles.upper[widest] - middles.lower[widest]) widest = axis;
  }
  return widest;
}

/** Halves along the widest axis, in a total order. */
Primitive* halved(const PrimitiveRun& run) {
  const int widest = widestAxis(run);
  Primitive* const middle = run.begin + run.size() / 2;
  std::nth_element(run.begin, middle, run.end, [widest](const Primitive& p, const Primitive& q) {
    return p.middle(widest) != q.middle(widest) ? p.middle(widest) < q.middle(widest) : p.element() < q.element();
  });
  return middle;
}

}  // namespace

PrimitiveRun boundedRun(Primitive* begin, Primitive* end) {
  const RunBounds bounds = sumOfParts(
      tbb::blocked_range<const Primitive*>(begin, end, MANY / 4), RunBounds(),
      [](const tbb::blocked_range<const Primitive*>& range, RunBounds sum) {
        for (const Primitive& p : range) sum.extend(p);
        return sum;
      },
      [](RunBounds sum, const RunBounds& other) {
        sum.extend(other);
        return sum;
      });
  return {begin, end, bounds};
}

void splitRun(const PrimitiveRun& run, SplitBy by, PrimitiveRun* left, PrimitiveRun* right) {
  if (by == SplitBy::MIDDLE) {
    const int axis = widestAxis(run);
    const float border = 0.5f * run.bounds.middles.lower[axis] + 0.5f * run.bounds.middles.upper[axis];
    partition(
        run, [=](const Primitive& p) { return p.middle(axis) < border; }, left, right);
    if (left->size() > 0 && right->size() > 0) return;
  }
  const Binning binning(run.bounds.middles);
  const Split split = by == SplitBy::COST ? splitByCost(run, binning) : Split();
  if (split.axis >= 0) {
    const int axis = split.axis;
    const float lower = binning.lower[axis], scale = binning.scale[axis], border = static_cast<float>(split.bin);
    partition(
        run, [=](const Primitive& p) { return (p.middle(axis) - lower) * scale < border; }, left, right);
    return;
  }
  Primitive* const middle = halved(run);
  *left = {run.begin, middle, boundsOf(run.begin, middle)};
  *right = {middle, run.end, boundsOf(middle, run.end)};
}

}  // namespace blem_sim::geometry
