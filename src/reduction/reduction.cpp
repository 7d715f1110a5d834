#include "blem_sim/reduction/reduction.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <climits>

#include "blem_sim/contact/contact_order.h"
#include "hull_stages.h"
#include "reduction_room.h"

namespace blem_sim::reduction {

namespace {

/** A pair's way to be reduced. */
struct Reducing {
  const Reduction& method;
  const ContactIds& chosen_before;
  ReductionWorkspace* workspace;

  void reduce(const std::vector<contact::Contact>& contacts, int k, std::vector<contact::Contact>* reduced) const {
    method.reduce(contacts, k, chosen_before, workspace, reduced);
  }
};

// Sound contacts take part in the choice; pierced ones, whose directions are the fallback's, get the room that is left, and a quarter of k
// if they are so many: else bodies that crossed would stay crossed.
void reduceContacts(const std::vector<contact::Contact>& contacts, int k, const Reducing& how, std::vector<contact::Contact>* reduced) {
  BudgetRoom* const room = &(*how.workspace)->budgets;
  const auto is_pierced = [](const contact::Contact& c) { return c.pierced; };
  if (std::none_of(contacts.begin(), contacts.end(), is_pierced)) return how.reduce(contacts, k, reduced);
  room->sound.clear();
  room->pierced.clear();
  for (const contact::Contact& contact : contacts) (contact.pierced ? room->pierced : room->sound).push_back(contact);
  const int reserved = std::min(k / 4, static_cast<int>(room->pierced.size()));
  how.reduce(room->sound, k - reserved, reduced);
  const int left = k - static_cast<int>(reduced->size());
  if (left <= 0) return;
  how.reduce(room->pierced, left, &room->more);
  reduced->insert(reduced->end(), room->more.begin(), room->more.end());
  std::sort(reduced->begin(), reduced->end(), contact::contactBefore);
}

constexpr int FLOOR = 3;  // contacts of a pair, if it has them, whatever budgets say: with none it falls through, with two it tips over

/** k shared by `counts`: manifolds that ask for few contacts get all of them, the others equal shares. The lack of a manifold's wrenches
 * depends on the number of contacts it keeps, hardly on the number it has: so the largest lack is the least. Each gets at least FLOOR, if
 * it has that, even where they sum to more than k. */
void fairShares(int k, BudgetRoom* room) {
  const std::vector<int>& counts = room->counts;
  std::vector<std::pair<int, int>>& order = room->order;
  order.clear();
  for (int i = 0; i < static_cast<int>(counts.size()); ++i) order.push_back({counts[i], i});
  std::sort(order.begin(), order.end());
  room->shares.resize(counts.size());
  int left = k, parties = static_cast<int>(counts.size());
  for (const auto& [count, party] : order) {
    const int share = std::min(count, std::max(left / parties--, FLOOR));
    room->shares[party] = share;
    left = std::max(0, left - share);
  }
}

using ModelManifold = std::vector<std::pair<int, int>>::const_iterator;

// Lowers the limits of a model's manifolds to their shares, if it has more contacts than its k.
void applyBudget(ModelManifold begin, ModelManifold end, int k, BudgetRoom* room) {
  std::vector<int>&limits = room->limits, &touching = room->touching;
  touching.clear();
  room->counts.clear();
  int total = 0;
  for (ModelManifold of_model = begin; of_model != end; ++of_model) {
    const int m = of_model->second;
    const int count = std::min(limits[m], room->sizes[m]);
    if (count == 0) continue;
    touching.push_back(m);
    room->counts.push_back(count);
    total += count;
  }
  if (total <= k) return;
  fairShares(k, room);
  for (std::size_t i = 0; i < touching.size(); ++i) limits[touching[i]] = std::min(limits[touching[i]], room->shares[i]);
}

// Lowers limits until every model keeps to its budget, or its pairs to FLOOR.
void applyBudgets(const ManifoldsToReduce& asked, BudgetRoom* room) {
  const std::vector<int>&model_a = asked.model_a, &model_b = asked.model_b;
  std::vector<std::pair<int, int>>& of_models = room->of_models;
  of_models.clear();
  for (int m = 0; m < static_cast<int>(model_a.size()); ++m) {
    of_models.push_back({model_a[m], m});
    if (model_b[m] != model_a[m]) of_models.push_back({model_b[m], m});
  }
  std::sort(of_models.begin(), of_models.end());
  for (ModelManifold begin = of_models.begin(), end = begin; begin != of_models.end(); begin = end) {
    while (end != of_models.end() && end->first == begin->first) ++end;
    applyBudget(begin, end, asked.budgets[begin->first].max_contacts, room);
  }
}

int countContacts(const std::vector<contact::ContactManifold>& manifolds) {
  int count = 0;
  for (const contact::ContactManifold& manifold : manifolds) count += static_cast<int>(manifold.contacts.size());
  return count;
}

void copyAllButContacts(const contact::ContactManifold& from, contact::ContactManifold* to) {
  to->a = from.a;
  to->b = from.b;
  to->layer = from.layer;
  to->pierced = from.pierced;
}

bool hasPierced(const std::vector<contact::Contact>& contacts) {
  return std::any_of(contacts.begin(), contacts.end(), [](const contact::Contact& c) { return c.pierced; });
}

// One manifold before budgets are shared out. `hull` alone can tell the number that it would keep before it chooses; others, and pierced
// contacts, are reduced to the limit, and again if it is lowered. @return number of contacts that would be kept
int prepare(const contact::ContactManifold& manifold, int limit, const Reducing& how, ThinnedContacts* thinned,
            std::vector<contact::Contact>* reduced) {
  const bool in_steps = how.method.reduce == static_cast<ReduceFunction>(reduceHull) && !hasPierced(manifold.contacts);
  if (in_steps && thinToHulls(manifold.contacts, &(*how.workspace)->hull, thinned))
    return std::min(limit, static_cast<int>(thinned->kept.size()));
  thinned->kept.clear();
  reduceContacts(manifold.contacts, limit, how, reduced);
  return static_cast<int>(reduced->size());
}

// Chooses within the limit, at least 1 where there are contacts. @return largest lack of those kept in any wrench
float finish(const contact::ContactManifold& manifold, int limit, const Reducing& how, const ThinnedContacts& thinned,
             std::vector<contact::Contact>* reduced) {
  HullRoom* const hull = &(*how.workspace)->hull;
  if (!thinned.kept.empty()) return chooseFromHulls({manifold.contacts, thinned, limit, how.chosen_before}, hull, reduced);
  if (limit < static_cast<int>(reduced->size())) {
    std::vector<contact::Contact>& again = (*how.workspace)->budgets.again;
    again = *reduced;
    reduceContacts(again, limit, how, reduced);
  }
  const bool all = reduced->size() == manifold.contacts.size();
  return all || hasPierced(manifold.contacts) ? 0 : hull->choice.lack(manifold.contacts, *reduced);
}

// Whether a pair has fewer contacts than it would have without a limit.
bool isCut(const contact::ContactManifold& manifold, int limit, const ThinnedContacts& thinned,
           const std::vector<contact::Contact>& reduced) {
  if (!thinned.kept.empty()) return reduced.size() < thinned.kept.size();
  return static_cast<int>(manifold.contacts.size()) > limit;
}

/** Calls work(manifold, workspace) for all, many on the threads of the TBB arena at hand. */
template <typename Work>
void forManifolds(int count, ReductionWorkspace* workspace, const Work& work) {
  constexpr int AT_ONCE = 16;  // the size of a chunk: some ten microseconds
  const int threads = tbb::this_task_arena::max_concurrency();
  if (threads == 1 || count <= AT_ONCE) {
    for (int m = 0; m < count; ++m) work(m, workspace);
    return;
  }
  std::vector<ReductionWorkspace>& of_threads = (*workspace)->of_threads;
  if (static_cast<int>(of_threads.size()) < threads) of_threads.resize(threads);
  tbb::parallel_for(tbb::blocked_range<int>(0, count, AT_ONCE), [&](const tbb::blocked_range<int>& range) {
    ReductionWorkspace* const of_thread = &of_threads[tbb::this_task_arena::current_thread_index()];
    for (int m = range.begin(); m < range.end(); ++m) work(m, of_thread);
  });
}

}  // namespace

const std::vector<Reduction>& reductionTable() {
  static const std::vector<Reduction> table = {
      {"hull", "corners of flat patches, then the contacts that span the wrenches best; keeps extremes", reduceHull},
      {"hierarchical", "means of average-linkage clusters [Hauser 2013]; k-means above 300 contacts", reduceHierarchical},
      {"kmeans", "means of k-means clusters [Hauser 2013]", reduceKmeans},
      {"none", "every contact, whatever k is; slow", reduceNone},
  };
  return table;
}

const Reduction* findReduction(const std::string& name) {
  for (const Reduction& reduction : reductionTable()) {
    if (name == reduction.name) return &reduction;
  }
  return nullptr;
}

void reduceNone(const std::vector<contact::Contact>& contacts, int, const ContactIds&, ReductionWorkspace*,
                std::vector<contact::Contact>* reduced) {
  *reduced = contacts;
  contact::makeCanonical(*reduced);
}

ReductionLoss reduceManifolds(const ManifoldsToReduce& asked, const Reduction& method, ReductionMemory* memory,
                              ReductionWorkspace* workspace, std::vector<contact::ContactManifold>* reduced) {
  const std::vector<contact::ContactManifold>& manifolds = asked.manifolds;
  BudgetRoom& room = (*workspace)->budgets;
  const bool all = method.reduce == reduceNone;
  const int count = static_cast<int>(manifolds.size());
  room.limits.resize(count);
  room.sizes.resize(count);
  if (static_cast<int>(room.thinned.size()) < count) room.thinned.resize(count);
  reduced->resize(count);
  const std::vector<ContactBudget>& budgets = asked.budgets;
  forManifolds(count, workspace, [&](int m, ReductionWorkspace* of_thread) {
    const Reducing how{method, memory->of(manifolds[m]), of_thread};
    copyAllButContacts(manifolds[m], &(*reduced)[m]);
    room.limits[m] = all ? INT_MAX : std::min(budgets[asked.model_a[m]].max_contacts, budgets[asked.model_b[m]].max_contacts);
    room.sizes[m] = prepare(manifolds[m], room.limits[m], how, &room.thinned[m], &(*reduced)[m].contacts);
  });
  if (all) return {};
  applyBudgets(asked, &room);
  room.lacks.resize(count);
  forManifolds(count, workspace, [&](int m, ReductionWorkspace* of_thread) {
    const Reducing how{method, memory->of(manifolds[m]), of_thread};
    room.lacks[m] = finish(manifolds[m], room.limits[m], how, room.thinned[m], &(*reduced)[m].contacts);
  });
  ReductionLoss loss;
  for (int m = 0; m < count; ++m) {
    if (!isCut(manifolds[m], room.limits[m], room.thinned[m], (*reduced)[m].contacts)) continue;
    ++loss.cut_pairs;
    loss.wrench = std::max(loss.wrench, static_cast<double>(room.lacks[m]));
  }
  memory->remember(*reduced);
  loss.contacts = countContacts(manifolds) - countContacts(*reduced);
  return loss;
}

// Most patches have fewer corners: so a warm step that sees the largest one so far finds room for it.
ReductionWorkspace::ReductionWorkspace() : room_(std::make_unique<Room>()) {
  constexpr std::size_t CORNERS = 256;
  PatchHullRoom& patch = room_->hull.patch;
  for (std::vector<PlanePoint>* points : {&patch.points, &patch.half, &patch.hull, &patch.ring, &patch.corners}) points->reserve(CORNERS);
  for (std::vector<double>* numbers : {&patch.places.x, &patch.places.y, &patch.places.depth}) numbers->reserve(CORNERS);
  for (std::vector<int>* indices : {&patch.farthest, &patch.outside}) indices->reserve(CORNERS);
}
ReductionWorkspace::~ReductionWorkspace() = default;
ReductionWorkspace::ReductionWorkspace(ReductionWorkspace&&) noexcept = default;
ReductionWorkspace& ReductionWorkspace::operator=(ReductionWorkspace&&) noexcept = default;

}  // namespace blem_sim::reduction
