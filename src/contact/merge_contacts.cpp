#include "merge_contacts.h"

#include <algorithm>
#include <tuple>

#include "contact_order.h"

namespace blem_sim {
namespace {

/** Of one id the one to keep comes first; total. */
bool keptBefore(const Contact& a, const Contact& b) {
  const auto key = [](const Contact& c) { return std::make_tuple(c.id, !c.pierced, -c.depth, c.point.x(), c.point.y(), c.point.z()); };
  return key(a) < key(b);
}

bool coincide(const Contact& a, const Contact& b) {
  return a.pierced == b.pierced && (a.point - b.point).squaredNorm() <= MERGE_DISTANCE * MERGE_DISTANCE &&
         (a.normal_BA - b.normal_BA).squaredNorm() <= MERGE_SINE * MERGE_SINE;
}

/** Contacts along UNCOMMON_DIRECTION, so that few share a place on it. */
class PlaceOrder {
 public:
  explicit PlaceOrder(const std::vector<Contact>& contacts) {
    places_.reserve(contacts.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) places_.emplace_back(UNCOMMON_DIRECTION.dot(contacts[i].point), i);
    std::sort(places_.begin(), places_.end());
    rank_.resize(contacts.size());
    for (std::size_t i = 0; i < places_.size(); ++i) rank_[places_[i].second] = i;
  }

  /** Calls visit(j) for every other contact that may be within MERGE_DISTANCE of i. */
  template <typename Visit>
  void visitNear(std::size_t i, Visit&& visit) const {
    const std::size_t rank = rank_[i];
    const double place = places_[rank].first;
    for (std::size_t r = rank; r-- > 0 && place - places_[r].first <= MERGE_DISTANCE;) visit(places_[r].second);
    for (std::size_t r = rank + 1; r < places_.size() && places_[r].first - place <= MERGE_DISTANCE; ++r) visit(places_[r].second);
  }

 private:
  std::vector<std::pair<double, std::size_t>> places_;
  std::vector<std::size_t> rank_;
};

}  // namespace

void mergeContacts(std::vector<Contact>* contacts) {
  std::sort(contacts->begin(), contacts->end(), keptBefore);
  const auto same_id = [](const Contact& a, const Contact& b) { return a.id == b.id; };
  contacts->erase(std::unique(contacts->begin(), contacts->end(), same_id), contacts->end());

  const PlaceOrder order(*contacts);
  std::vector<char> absorbed(contacts->size(), false);
  std::vector<Contact> merged;
  merged.reserve(contacts->size());
  for (std::size_t i = 0; i < contacts->size(); ++i) {
    if (absorbed[i]) continue;
    const Contact& first = (*contacts)[i];
    std::size_t deepest = i;
    order.visitNear(i, [&](std::size_t j) {
      const Contact& other = (*contacts)[j];
      if (j < i || absorbed[j] || !coincide(first, other)) return;
      absorbed[j] = true;
      const Contact& best = (*contacts)[deepest];
      if (std::make_pair(-other.depth, other.id) < std::make_pair(-best.depth, best.id)) deepest = j;
    });
    merged.push_back((*contacts)[deepest]);
    merged.back().id = first.id;
  }
  contacts->swap(merged);
}

}  // namespace blem_sim
