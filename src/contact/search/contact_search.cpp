#include "search/contact_search.h"

#include <algorithm>
#include <cmath>

#include "kept/list_schedule.h"

namespace blem_sim::contact {
namespace {

/** Largest error [m] of a distance. */
constexpr double DISTANCE_ROUNDING = 1e-7;

/** Whether the memory is of these two meshes. */
bool isOf(const ContactSearchMemory& memory, const MeshPair& pair) {
  return memory.moving == pair.moving.identity && memory.fixed == pair.fixed.identity;
}

/** One search, with the memory of the pair. */
class ContactSearch {
 public:
  ContactSearch(const MeshPair& pair, ContactSearchMemory* memory, ContactSearchBuffers* buffers, EvaluatedContacts* found)
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

  /** Figures by which lists are planned. */
  ListFigures figures() const {
    const CandidateListing& list = memory_.contacts.now;
    return {
        memory_.visited,          pair_.range, motion_.motion, motion_.turn, memory_.growth, list.pairs.size(), list.lists.pairs.contacts(),
        list.origin.margin.motion};
  }

  ListMargin nextMargin(CandidateKind kind) const {
    const ListFigures now = figures();
    if (ListSchedule::isFast(now)) return {};
    if (kind == CandidateKind::CONTACTS) return ListSchedule::contactMargin(now, ListSchedule::partOf(pair_.X_FM));
    const NearRegion::Motions step = memory_.visited ? region_.motions(pair_.X_FM, memory_.X_FM) : NearRegion::Motions::Zero();
    return marginAlong(step, ListSchedule::crossingSteps(now), ListSchedule::LEAST_NEAREST_MARGIN * pair_.range);
  }

  Vector3 middle() const { return pair_.moving.bounds.center(); }

  bool isGood(const ListOrigin& origin) const { return origin.known && isGoodAt(pair_.X_FM, origin); }

  bool isGoodAt(const Pose& X_FM, const ListOrigin& origin) const { return region_.used(origin, X_FM, pair_.range) <= 1; }

  /** The pair where a list of that margin is best made: so far ahead on its way that the list is good from now on until long after. */
  MeshPair ahead(const ListMargin& margin) const {
    MeshPair ahead = pair_;
    const Pose X_FM = memory_.motion.after(ListSchedule::stepsAhead(margin.motion, figures()), pair_.X_FM, middle());
    if (isGoodAt(X_FM, {true, pair_.X_FM, pair_.range, ListSchedule::marginAhead(margin)})) ahead.X_FM = X_FM;
    return ahead;
  }

  /** Leaves a list that is good; its successor is made a part at a time, in the last steps that it is good for. */
  void refresh(CandidateKind kind, bool keeps, KeptListing* kept) {
    CandidateListing& next = kept->next;
    const bool good = isGood(kept->now.origin), next_is_good = isGood(next.origin);
    if (next_is_good) {
      const bool waits = good && next.left() > 0;
      findMoreCandidates(pair_, waits ? ListSchedule::partOfPairs(next.pairs.size()) : next.left(), &buffers_.search, &next);
      if (!waits) replace(kind, kept);
      return;
    }
    if (good && (memory_.contacts.now.pairs.size() <= ListSchedule::FEW_LEAF_PAIRS || !endsSoon(kept->now.origin))) return;
    const ListMargin margin = keeps ? nextMargin(kind) : ListMargin();
    if (!good) {
      findCandidates(ahead(margin), kind, margin, &buffers_.search, &next);
      replace(kind, kept);
    } else if (ListSchedule::lasts(margin.motion, figures())) {
      beginCandidates(ahead(margin), kind, margin, &buffers_.search, &next);
    }
  }

  void replace(CandidateKind kind, KeptListing* kept) {
    std::swap(kept->now, kept->next);
    kept->next.origin.known = false;
    if (kind == CandidateKind::CONTACTS) memory_.nearest_origin.known = false;
  }

  /** Whether lists of that origin will be used up while the next one is made. */
  bool endsSoon(const ListOrigin& origin) const {
    return ListSchedule::endsSoon(region_.used(origin, memory_.X_FM, pair_.range), region_.used(origin, pair_.X_FM, pair_.range));
  }

  /** The candidates to test, good lists given. */
  const CandidatePairs& nearestPairs() {
    if (isGood(memory_.nearest_origin)) return memory_.nearest;
    const ListFigures now = figures();
    const ListMargin margin = ListSchedule::nearestMargin(now);
    CandidateListing& all = memory_.contacts.now;
    if (!ListSchedule::isWorthChoosing(margin.motion, now)) return all.lists.pairs;
    const MeshPair ahead = this->ahead(margin);
    buffers_.evaluation.turned.turnForContacts(all.lists, ahead.X_FM);
    const std::size_t near =
        findNearest(ahead, {all.lists, buffers_.evaluation.turned}, margin, &buffers_.evaluation.surroundings, &memory_.nearest);
    memory_.nearest_origin = {true, ahead.X_FM, pair_.range, margin};
    memory_.growth = ListSchedule::growth(near, margin.motion, now);
    return memory_.nearest;
  }

  const MeshPair& pair_;
  ContactSearchMemory& memory_;
  ContactSearchBuffers& buffers_;
  EvaluatedContacts& found_;
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

void searchContacts(const MeshPair& pair, ContactSearchMemory* memory, ContactSearchBuffers* buffers, EvaluatedContacts* found) {
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
