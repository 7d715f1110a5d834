#include "choice/wrench_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "blem_sim/contact/contact_order.h"
#include "choice/continued_choice.h"
#include "choice/overtaken.h"
#include "lanes/reduction_lanes.h"

namespace blem_sim::reduction {

namespace {

// [m] Once no wrench lacks, depth counts too, a unit force per this depth.
constexpr double DEPTH_SCALE = 1e-3;
constexpr float NOTHING_LACKS = 1e-6f;  // part of a unit force
// Additional lack in directions between those looked at, of a unit force, and of the lack in those looked at.
constexpr float BETWEEN = 0.1f, MORE_BETWEEN = 0.3f;

double nextUniform(std::uint64_t& state) {  // splitmix64
  std::uint64_t z = (state += 0x9E3779B97F4A7C15ull);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

// The twelve axis directions, then directions spread evenly over the 6-D sphere (sums of uniform numbers are nearly normal).
WrenchDirections makeDirections() {
  WrenchDirections directions;
  std::uint64_t state = 1;
  for (int i = 0; i < WRENCH_DIRECTIONS; ++i) {
    Eigen::Matrix<double, 6, 1> d = Eigen::Matrix<double, 6, 1>::Zero();
    if (i < 12) {
      d[i / 2] = i % 2 ? -1 : 1;
    } else {
      for (int axis = 0; axis < 6; ++axis) {
        for (int sum = 0; sum < 12; ++sum) d[axis] += nextUniform(state) - 0.5;
      }
      d.normalize();
    }
    for (int axis = 0; axis < 3; ++axis) {
      directions.force[axis][i] = static_cast<float>(d[axis]);
      directions.torque[axis][i] = static_cast<float>(d[3 + axis]);
    }
  }
  return directions;
}

// Index of the farthest along UNCOMMON_DIRECTION among the candidates of at least this depth; -1 if there is none.
int farthestAsDeep(const std::vector<contact::Contact>& contacts, const std::vector<int>& candidates, double depth) {
  int best = -1;
  double farthest = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const contact::Contact& contact = contacts[candidates[i]];
    if (contact.depth < depth) continue;
    const double place = contact::UNCOMMON_DIRECTION.dot(contact.point);
    if (best >= 0 && place <= farthest) continue;
    best = static_cast<int>(i);
    farthest = place;
  }
  return best;
}

// Index of the deepest candidate; of those that are as deep but for rounding the farthest, so that the names of vertices do not decide.
// Hulls may have left out contacts that are deeper by some roundings.
int deepest(const std::vector<contact::Contact>& contacts, const std::vector<int>& candidates, const PatchScale& scale) {
  const int best = farthestAsDeep(contacts, candidates, scale.depth() - DEPTH_TIE);
  if (best >= 0) return best;
  double depth = -std::numeric_limits<double>::infinity();
  for (const int candidate : candidates) depth = std::max(depth, contacts[candidate].depth);
  return farthestAsDeep(contacts, candidates, depth - DEPTH_TIE);
}

}  // namespace

/** The wrenches that candidates reach, and those that the chosen ones do. */
class WrenchChoice::Spans {
 public:
  /** Candidates that cannot be extreme are left out. */
  void start(const ChoiceQuestion& asked, std::vector<int>* candidates) {
    points_.clear();
    for (const int candidate : *candidates) points_.push_back(wrenchPoint(asked.contacts[candidate], asked.scale));
    dropOvertaken(asked.contacts, asked.chosen_before, candidates, &points_);
    if (components_.size() < points_.size()) components_.resize(points_.size());
    findWrenches(directions_, points_.data(), static_cast<int>(points_.size()), components_.data(), &extremes_);
  }

  /** Makes depth count too from now on. */
  void countDepth(const std::vector<contact::Contact>& contacts, const std::vector<int>& candidates) {
    for (std::size_t i = 0; i < candidates.size(); ++i)
      points_[i].handicap -= static_cast<float>(std::max(0.0, contacts[candidates[i]].depth) / DEPTH_SCALE);
    findWrenchExtremes(components_.data(), points_.data(), static_cast<int>(points_.size()), &extremes_);
  }

  /** Adds to `chosen`, indices of candidates, the extreme ones of the directions that lack most, until k are chosen or nothing lacks.
   * @return largest lack left */
  float addExtremes(int k, std::vector<int>* chosen) {
    std::fill(std::begin(reached_.value), std::end(reached_.value), -std::numeric_limits<float>::infinity());
    float lack = 0;
    for (const int candidate : *chosen) lack = add(candidate);
    while (lack > NOTHING_LACKS && static_cast<int>(chosen->size()) < k) {
      chosen->push_back(extremeAlong(firstLacking(extremes_, reached_, lack)));
      lack = add(chosen->back());
    }
    return lack;
  }

  /** Lack of `others` in the wrenches of `contacts`. */
  float lackOf(const std::vector<contact::Contact>& contacts, const std::vector<contact::Contact>& others, const PatchScale& scale) {
    const auto findExtremes = [&](const std::vector<contact::Contact>& of, WrenchComponents* extremes) {
      points_.clear();
      for (const contact::Contact& contact : of) points_.push_back(wrenchPoint(contact, scale));
      if (components_.size() < points_.size()) components_.resize(points_.size());
      findWrenches(directions_, points_.data(), static_cast<int>(points_.size()), components_.data(), extremes);
    };
    findExtremes(contacts, &extremes_);
    findExtremes(others, &reached_);
    float lack = 0;
    for (int d = 0; d < WRENCH_DIRECTIONS; ++d) lack = std::max(lack, extremes_.value[d] - reached_.value[d]);
    return lack;
  }

 private:
  float add(int candidate) { return addWrenches(components_[candidate], points_[candidate].handicap, extremes_, &reached_); }

  /** The first candidate that is extreme in a direction. */
  int extremeAlong(int direction) const {
    int first = 0;
    while (components_[first].value[direction] - points_[first].handicap != extremes_.value[direction]) ++first;
    return first;
  }

  const WrenchDirections directions_ = makeDirections();
  std::vector<WrenchPoint> points_;
  std::vector<WrenchComponents> components_;  // per point; room for more
  WrenchComponents extremes_, reached_;
};

namespace {

// Indices of those candidates that were chosen before; none if they are too many. Both are sorted by id.
void findContinued(const std::vector<contact::Contact>& contacts, const std::vector<int>& candidates, int k,
                   const ContactIds& chosen_before, std::vector<int>* there) {
  there->clear();
  auto before = chosen_before.begin();
  for (std::size_t i = 0; i < candidates.size() && before != chosen_before.end(); ++i) {
    const std::uint64_t id = contacts[candidates[i]].id;
    while (before != chosen_before.end() && *before < id) ++before;
    if (before != chosen_before.end() && *before == id) there->push_back(static_cast<int>(i));
  }
  if (static_cast<int>(there->size()) > k) there->clear();
}

/** Bound on the lack in any direction. */
float atMost(float lack) { return (1 + MORE_BETWEEN) * std::max(0.0f, lack) + BETWEEN; }

}  // namespace

WrenchChoice::WrenchChoice() : spans_(std::make_unique<Spans>()) {}
WrenchChoice::~WrenchChoice() = default;

// Adds the deepest of the members not chosen until k are.
void WrenchChoice::addDeepest(const ChoiceQuestion& asked, std::vector<int>* chosen) {
  const std::vector<contact::Contact>& contacts = asked.contacts;
  taken_ = *chosen;
  std::sort(taken_.begin(), taken_.end());
  rest_.clear();
  for (const int member : asked.members) {
    if (!std::binary_search(taken_.begin(), taken_.end(), member)) rest_.push_back(member);
  }
  const std::size_t room = std::min(rest_.size(), static_cast<std::size_t>(asked.k) - chosen->size());
  std::partial_sort(rest_.begin(), rest_.begin() + room, rest_.end(), [&](int a, int b) {
    return contacts[a].depth != contacts[b].depth ? contacts[a].depth > contacts[b].depth
                                                  : contact::contactBefore(contacts[a], contacts[b]);
  });
  chosen->insert(chosen->end(), rest_.begin(), rest_.begin() + room);
}

float WrenchChoice::choose(const ChoiceQuestion& asked, std::vector<int>* candidates, std::vector<int>* chosen) {
  const std::vector<contact::Contact>& contacts = asked.contacts;
  const int k = asked.k;
  order_.sort(contacts, candidates);
  spans_->start(asked, candidates);
  const int deep = deepest(contacts, *candidates, asked.scale);

  findContinued(contacts, *candidates, k, asked.chosen_before, &continued_);
  float lack = std::numeric_limits<float>::infinity();
  if (!continued_.empty()) {
    lack = spans_->addExtremes(k, &continued_);
    double depth = -std::numeric_limits<double>::infinity();
    for (const int i : continued_) depth = std::max(depth, contacts[(*candidates)[i]].depth);
    if (depth < contacts[(*candidates)[deep]].depth - DEEP_ENOUGH) lack = std::numeric_limits<float>::infinity();
  }
  if (lack <= GOOD_ENOUGH) {  // a fresh choice lacks nothing at best
    chosen->swap(continued_);
  } else {
    chosen->assign(1, deep);
    const float fresh = spans_->addExtremes(k, chosen);
    const bool goes_on = lack <= fresh + GOOD_ENOUGH;
    if (goes_on) chosen->swap(continued_);
    if (!goes_on) lack = fresh;
  }
  if (static_cast<int>(chosen->size()) < k) {
    spans_->countDepth(contacts, *candidates);
    spans_->addExtremes(k, chosen);
  }
  for (int& i : *chosen) i = (*candidates)[i];
  if (static_cast<int>(chosen->size()) < k) addDeepest(asked, chosen);
  return atMost(lack);
}

float WrenchChoice::lack(const std::vector<contact::Contact>& all, const std::vector<contact::Contact>& kept) {
  bool sound = true;
  const PatchScale scale(all, &sound);
  return sound ? atMost(spans_->lackOf(all, kept, scale)) : 1;
}

}  // namespace blem_sim::reduction
