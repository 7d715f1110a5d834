#include "search/contact_search.h"

#include <algorithm>
#include <cmath>

namespace blem_sim::contact {
namespace {

// A list is made for so many steps of the present motion, or for the cheapest number if the growth of the pair's lists is known.
constexpr double MARGIN_STEPS = 15, FEWEST_STEPS = 3, MOST_STEPS = 50;
constexpr double LEAST_PART = 0.7;  // part of those steps, see partOf
// Cost of making a list per pair of leaves, and per candidate, in candidates that findNearest looks at, and the steps that its choice
// lasts.
constexpr double LEAF_PAIR_COST = 40, CANDIDATE_COST = 8, CHOICE_STEPS = 8;
// The next list is made in so many parts, in as many steps before it is needed, if it lasts and its pairs of leaves are not few.
constexpr std::size_t PARTS = 4, FEW_LEAF_PAIRS = 64;
constexpr double LASTING_STEPS = 5;
// A list is made for a pose ahead, so much of its margin away on the way of the pair, and so many steps, at most.
constexpr double AHEAD = 0.9, AHEAD_AT_MOST = 0.98, AHEAD_STEPS = 16;
// Candidates of long lists that matter for so few steps are listed again; or for the cheapest number if the growth of lists is known.
constexpr double NEAREST_STEPS = 3, FEWEST_NEAREST_STEPS = 2, MOST_NEAREST_STEPS = 8;
constexpr double MOST_NEAREST_PART = 0.4;  // part of a list's margin
// Candidates for crossings are listed for so many steps, or for those that fit into the largest margin.
constexpr double CROSSING_STEPS = 10;
constexpr std::size_t FEW_CANDIDATES = 50;
constexpr double LEAST_MARGIN = 0.02, MOST_MARGIN = 0.8, LEAST_NEAREST_MARGIN = 0.005;  // parts of the range
constexpr double MOST_KNOWN_MARGIN = 2.2;                                               // where the growth of lists is known
// Lists of fast bodies grow faster than their margins where there are many pairs of leaves.
constexpr std::size_t MANY_LEAF_PAIRS = 4000;
constexpr double MOST_MARGIN_OF_MANY = 0.3;
constexpr double FIRST_MARGIN = 0.1;  // part of the range, where the motion is not known yet
// Margins of directions: lengths of the difference of unit vectors.
constexpr double LEAST_TURN = 0.005, LEAST_NEAREST_TURN = 0.001, FIRST_TURN = 0.05;
/** Largest error [m] of a distance. */
constexpr double DISTANCE_ROUNDING = 1e-7;

/** Whether the memory is of these two meshes. */
bool isOf(const ContactSearchMemory& memory, const MeshPair& pair) {
  return memory.moving == pair.moving.identity && memory.fixed == pair.fixed.identity;
}

/** A number from LEAST_PART to 1 that is another for every pose: pairs that set out together shall not all need new lists in one step. */
double partOf(const Pose& X) {
  constexpr double GRAIN = 1e-7;  // [m]
  const double grains = X.translation().sum() / GRAIN;
  return LEAST_PART + (1 - LEAST_PART) * (grains - std::floor(grains));
}

/** One search, with the memory of the pair. */
class ContactSearch {
 public:
  ContactSearch(const MeshPair& pair, ContactSearchMemory* memory, ContactSearchBuffers* buffers, FoundContacts* found)
      : pair_(pair), memory_(*memory), buffers_(*buffers), found_(*found), region_(pair) {
    if (!isOf(*memory, pair)) forget();
    if (!memory_.visited) return;
    motion_ = {region_.largestMotion(pair.X_FM, memory_.X_FM), largestTurn(pair.X_FM, memory_.X_FM)};
    memory_.motion.add(memory_.X_FM, pair.X_FM, middle());
  }

  void run(bool keeps) {
    if (haveEdges() && !staysApart()) {
      refresh(CandidateKind::CROSSINGS, keeps, &memory_.crossings);
      CandidateLists& lists = memory_.crossings.now.lists;
      buffers_.evaluation.turned.turnForCrossings(lists, pair_.X_FM);
      Evaluation(pair_, &lists, lists.pairs, &buffers_.evaluation, &found_).findCrossings();
    }
    refresh(CandidateKind::CONTACTS, keeps, &memory_.contacts);
    CandidateLists& lists = memory_.contacts.now.lists;
    const CandidatePairs& pairs = nearestPairs();
    buffers_.evaluation.turned.turnForContacts(lists, pair_.X_FM);
    Evaluation(pair_, &lists, pairs, &buffers_.evaluation, &found_).findContacts();
    memory_.visited = keeps;
    memory_.X_FM = pair_.X_FM;
    memory_.distance = found_.crossings.empty() ? found_.leastGap(pair_) : 0;
  }

 private:
  /** Whether both meshes have edges. Point clouds have none, so they cannot cross anything. */
  bool haveEdges() const { return pair_.moving.topology.edgeCount() > 0 && pair_.fixed.topology.edgeCount() > 0; }

  /** Whether the meshes surely stayed apart since the last search. Points near the fixed mesh move straight, and the place nearest to each
   * lies along a normal of that mesh, so the distance shrinks by no more than they move along its normals there. */
  bool staysApart() const {
    if (!memory_.visited) return false;
    if (motion_.motion + DISTANCE_ROUNDING < memory_.distance) return true;
    const CandidateListing& list = memory_.contacts.now;
    if (!isGood(list.origin) || !isGoodAt(memory_.X_FM, list.origin)) return false;
    return region_.largestMotion(pair_.X_FM, memory_.X_FM, list.normals) + DISTANCE_ROUNDING < std::min(memory_.distance, pair_.range);
  }

  void forget() {
    memory_.visited = memory_.nearest_origin.known = false;
    memory_.motion = SteadyMotion();
    memory_.growth = 0;
    for (KeptListing* kept : {&memory_.contacts, &memory_.crossings}) kept->now.origin.known = kept->next.origin.known = false;
    memory_.moving = pair_.moving.identity;
    memory_.fixed = pair_.fixed.identity;
  }

  /** Whether the pair is too fast for lists to last. */
  bool isFast() const { return FEWEST_STEPS * motion_.motion > MOST_MARGIN * pair_.range; }

  /** Whether the list has so many pairs of leaves that lists grow faster than their margins. */
  bool areMany() const { return memory_.contacts.now.pairs.size() > MANY_LEAF_PAIRS; }
  /** Largest margin [m] of lists whose growth is not known. */
  double mostMargin() const { return (areMany() ? MOST_MARGIN_OF_MANY : MOST_MARGIN) * pair_.range; }

  ListMargin contactMargin() const {
    if (!memory_.visited) return {FIRST_MARGIN * pair_.range, FIRST_TURN};
    const bool known = memory_.growth > 0 && !areMany();
    const double most = known ? MOST_KNOWN_MARGIN * pair_.range : mostMargin();
    // Turning is allowed for as long as moving.
    double steps = (known ? cheapestSteps() : MARGIN_STEPS) * partOf(pair_.X_FM);
    if (steps * motion_.motion > most) steps = most / motion_.motion;
    return {std::max(steps * motion_.motion, LEAST_MARGIN * pair_.range), std::max(steps * motion_.turn, LEAST_TURN)};
  }

  /** Steps of the cheapest list. A longer list is made less often, but its additional candidates are looked at whenever the nearest are
   * chosen. A list of margin m lasts 2 m / motion steps; it takes some cost anyway and some more in proportion to m. */
  double cheapestSteps() const {
    if (motion_.motion <= 0) return MOST_STEPS;
    const CandidateListing& list = memory_.contacts.now;
    const double nearby = list.lists.pairs.contacts() - memory_.growth * list.origin.margin.motion;
    const double anyway = LEAF_PAIR_COST * list.pairs.size() + CANDIDATE_COST * std::max(nearby, 0.0);
    const double margin = std::sqrt(0.5 * anyway * motion_.motion * CHOICE_STEPS / memory_.growth);
    return std::clamp(margin / motion_.motion, FEWEST_STEPS, MOST_STEPS);
  }

  ListMargin crossingMargin() const {
    const NearRegion::Motions step = memory_.visited ? region_.motions(pair_.X_FM, memory_.X_FM) : NearRegion::Motions::Zero();
    const double steps = CROSSING_STEPS * motion_.motion > mostMargin() ? mostMargin() / motion_.motion : CROSSING_STEPS;
    return marginAlong(step, steps, LEAST_NEAREST_MARGIN * pair_.range);
  }

  Vector3 middle() const { return pair_.moving.bounds.center(); }

  bool isGood(const ListOrigin& origin) const { return origin.known && isGoodAt(pair_.X_FM, origin); }

  bool isGoodAt(const Pose& X_FM, const ListOrigin& origin) const { return region_.used(origin, X_FM, pair_.range) <= 1; }

  /** The pair where a list of that margin is best made: so far ahead on its way that the list is good from now on until long after. */
  MeshPair ahead(const ListMargin& margin) const {
    MeshPair ahead = pair_;
    const double steps = motion_.motion > 0 ? std::min(AHEAD * margin.motion / motion_.motion, AHEAD_STEPS) : 0;
    const Pose X_FM = memory_.motion.after(steps, pair_.X_FM, middle());
    const ListMargin nearer{AHEAD_AT_MOST * margin.motion, AHEAD_AT_MOST * margin.turn, AHEAD_AT_MOST * margin.ways};
    if (isGoodAt(X_FM, {true, pair_.X_FM, pair_.range, nearer})) ahead.X_FM = X_FM;
    return ahead;
  }

  /** Leaves a list that is good; its successor is made a part at a time, in the last steps that it is good for. */
  void refresh(CandidateKind kind, bool keeps, KeptListing* kept) {
    CandidateListing& next = kept->next;
    const bool good = isGood(kept->now.origin), next_is_good = isGood(next.origin);
    if (next_is_good) {
      const bool waits = good && next.left() > 0;
      findMoreCandidates(pair_, waits ? (next.pairs.size() + PARTS - 1) / PARTS : next.left(), &buffers_.search, &next);
      if (!waits) replace(kind, kept);
      return;
    }
    if (good && (memory_.contacts.now.pairs.size() <= FEW_LEAF_PAIRS || !endsSoon(kept->now.origin))) return;
    const ListMargin margin = !keeps || isFast() ? ListMargin() : kind == CandidateKind::CONTACTS ? contactMargin() : crossingMargin();
    if (!good) {
      findCandidates(ahead(margin), kind, margin, &buffers_.search, &next);
      replace(kind, kept);
    } else if (lasts(margin)) {
      beginCandidates(ahead(margin), kind, margin, &buffers_.search, &next);
    }
  }

  void replace(CandidateKind kind, KeptListing* kept) {
    std::swap(kept->now, kept->next);
    kept->next.origin.known = false;
    if (kind != CandidateKind::CONTACTS) return;
    memory_.nearest_origin.known = false;
    groupByFaces(pair_, &kept->now.lists, &memory_.nearest);
  }

  /** Whether a list of that margin is good for much longer than its making takes. */
  bool lasts(const ListMargin& margin) const { return LASTING_STEPS * motion_.motion <= margin.motion; }

  /** Whether lists of that origin are good for no longer than making the next one takes, if the pair goes on to leave it as it does. */
  bool endsSoon(const ListOrigin& origin) const {
    constexpr double STEPS = PARTS + 1;
    const double before = region_.used(origin, memory_.X_FM, pair_.range), now = region_.used(origin, pair_.X_FM, pair_.range);
    return now > before && now + STEPS * (now - before) > 1;
  }

  /** Margin of the nearest candidates for so many steps of the present motion. */
  ListMargin marginOf(double steps) const {
    return {std::clamp(steps * motion_.motion, LEAST_NEAREST_MARGIN * pair_.range, MOST_MARGIN * pair_.range),
            std::max(steps * motion_.turn, LEAST_NEAREST_TURN)};
  }

  /** The steps that the nearest are chosen for: for more there are more to test, for fewer all are looked at more often. To look at one
   * takes about as long as to test it; a choice of margin m lasts 2 m / motion steps. Few enough for a choice, if the list's margin is not
   * too small for any. */
  double nearestSteps() const {
    const CandidateListing& list = memory_.contacts.now;
    const double all = list.lists.pairs.contacts(), more_per_step = memory_.growth * motion_.motion;
    if (more_per_step <= 0) return NEAREST_STEPS;
    const double worth = MOST_NEAREST_PART * list.origin.margin.motion / motion_.motion;
    const double most = std::clamp(worth, FEWEST_NEAREST_STEPS, MOST_NEAREST_STEPS);
    return std::clamp(std::sqrt(0.5 * all / more_per_step), FEWEST_NEAREST_STEPS, most);
  }

  /** The candidates to test, good lists given. */
  const CandidatePairs& nearestPairs() {
    if (isGood(memory_.nearest_origin)) return memory_.nearest;
    const ListMargin margin = marginOf(nearestSteps());
    CandidateListing& all = memory_.contacts.now;
    if (all.lists.pairs.contacts() <= FEW_CANDIDATES || margin.motion >= 0.5 * all.origin.margin.motion) return all.lists.pairs;
    const MeshPair ahead = this->ahead(margin);
    buffers_.evaluation.turned.turnForContacts(all.lists, ahead.X_FM);
    const std::size_t near =
        findNearest(ahead, buffers_.evaluation.turned, margin, all.lists, &buffers_.evaluation.surroundings, &memory_.nearest);
    memory_.nearest_origin = {true, ahead.X_FM, pair_.range, margin};
    const double more = static_cast<double>(all.lists.pairs.contacts() - near);
    memory_.growth = std::max(more, 1.0) / (all.origin.margin.motion - margin.motion);
    return memory_.nearest;
  }

  const MeshPair& pair_;
  ContactSearchMemory& memory_;
  ContactSearchBuffers& buffers_;
  FoundContacts& found_;
  const NearRegion region_;
  ListMargin motion_;  // since the last search
};

/** Whether a pair that was apart and without candidates has surely moved by so little that it is so still: a bound on the motion of all
 * points tells. Apart by more than the margin when last seen, it did not cross where the list was made. */
bool staysEmpty(const MeshPair& pair, const ContactSearchMemory& memory) {
  const CandidateListing& list = memory.contacts.now;
  const ListOrigin& origin = list.origin;
  if (!isOf(memory, pair) || !memory.visited || !origin.known) return false;
  if (list.lists.pairs.contacts() > 0 || memory.distance <= origin.margin.motion) return false;
  const Box& bounds = pair.moving.bounds;
  const Vector3 middle = bounds.center();
  const double reach = 0.5 * bounds.diagonal().norm() + std::sqrt(3.0) * pair.range, turn = largestTurn(pair.X_FM, origin.X_FM),
               motion = (pair.X_FM * middle - origin.X_FM * middle).norm() + reach * turn;
  return usedMargin(origin, pair.range, motion, turn) <= 1;
}

}  // namespace

void searchContacts(const MeshPair& pair, ContactSearchMemory* memory, ContactSearchBuffers* buffers, FoundContacts* found) {
  found->clear();
  if (memory && staysEmpty(pair, *memory)) {
    memory->X_FM = pair.X_FM;
    memory->motion = SteadyMotion();
    memory->distance = pair.range;
  } else if (!memory) {
    buffers->unknown.moving = 0;
    ContactSearch(pair, &buffers->unknown, buffers, found).run(false);
  } else {
    ContactSearch(pair, memory, buffers, found).run(true);
  }
}

}  // namespace blem_sim::contact
