#include "blem_sim/reduction/reduction.h"

#include <algorithm>
#include <climits>

#include "blem_sim/contact/contact_order.h"
#include "choice/wrench_choice.h"
#include "hull_stages.h"

namespace blem_sim::reduction {

namespace {

// Kept between calls.
struct ReductionBuffers {
  std::vector<contact::Contact> sound, pierced, more, again;
  std::vector<ThinnedContacts> thinned;  // manifold by manifold
  std::vector<int> limits, sizes;        // manifold by manifold: numbers of contacts that may be kept, and would be
  std::vector<int> touching, counts, shares;
  std::vector<std::pair<int, int>> of_models;  // (model, manifold)
  std::vector<std::pair<int, int>> order;      // (count, party)
};

// Sound contacts take part in the choice; pierced ones, whose directions are the fallback's, get the room that is left, and a quarter of k
// if they are so many: else bodies that crossed would stay crossed.
void reduceContacts(const std::vector<contact::Contact>& contacts, int k, const Reduction& method, const ContactIds& chosen_before,
                    ReductionBuffers* buffers, std::vector<contact::Contact>* reduced) {
  const auto is_pierced = [](const contact::Contact& c) { return c.pierced; };
  if (std::none_of(contacts.begin(), contacts.end(), is_pierced)) return method.reduce(contacts, k, chosen_before, reduced);
  buffers->sound.clear();
  buffers->pierced.clear();
  for (const contact::Contact& contact : contacts) (contact.pierced ? buffers->pierced : buffers->sound).push_back(contact);
  const int reserved = std::min(k / 4, static_cast<int>(buffers->pierced.size()));
  method.reduce(buffers->sound, k - reserved, chosen_before, reduced);
  const int room = k - static_cast<int>(reduced->size());
  if (room <= 0) return;
  method.reduce(buffers->pierced, room, chosen_before, &buffers->more);
  reduced->insert(reduced->end(), buffers->more.begin(), buffers->more.end());
  std::sort(reduced->begin(), reduced->end(), contact::contactBefore);
}

constexpr int FLOOR = 3;  // contacts of a pair, if it has them, whatever budgets say: with none it falls through, with two it tips over

/** k shared by `counts`: manifolds that ask for few contacts get all of them, the others equal shares. The lack of a manifold's wrenches
 * depends on the number of contacts it keeps, hardly on the number it has: so the largest lack is the least. Each gets at least FLOOR, if
 * it has that, even where they sum to more than k. */
void fairShares(int k, ReductionBuffers* buffers) {
  const std::vector<int>& counts = buffers->counts;
  std::vector<std::pair<int, int>>& order = buffers->order;
  order.clear();
  for (int i = 0; i < static_cast<int>(counts.size()); ++i) order.push_back({counts[i], i});
  std::sort(order.begin(), order.end());
  buffers->shares.resize(counts.size());
  int left = k, parties = static_cast<int>(counts.size());
  for (const auto& [count, party] : order) {
    const int share = std::min(count, std::max(left / parties--, FLOOR));
    buffers->shares[party] = share;
    left = std::max(0, left - share);
  }
}

using ModelManifold = std::vector<std::pair<int, int>>::const_iterator;

// Lowers the limits of a model's manifolds to their shares, if it has more contacts than its k.
void applyBudget(ModelManifold begin, ModelManifold end, int k, ReductionBuffers* buffers) {
  std::vector<int>&limits = buffers->limits, &touching = buffers->touching;
  touching.clear();
  buffers->counts.clear();
  int total = 0;
  for (ModelManifold of_model = begin; of_model != end; ++of_model) {
    const int m = of_model->second;
    const int count = std::min(limits[m], buffers->sizes[m]);
    if (count == 0) continue;
    touching.push_back(m);
    buffers->counts.push_back(count);
    total += count;
  }
  if (total <= k) return;
  fairShares(k, buffers);
  for (std::size_t i = 0; i < touching.size(); ++i) limits[touching[i]] = std::min(limits[touching[i]], buffers->shares[i]);
}

// Lowers limits until every model keeps to its budget, or its pairs to FLOOR.
void applyBudgets(const std::vector<int>& model_a, const std::vector<int>& model_b, const std::vector<ContactBudget>& budgets,
                  ReductionBuffers* buffers) {
  std::vector<std::pair<int, int>>& of_models = buffers->of_models;
  of_models.clear();
  for (int m = 0; m < static_cast<int>(model_a.size()); ++m) {
    of_models.push_back({model_a[m], m});
    if (model_b[m] != model_a[m]) of_models.push_back({model_b[m], m});
  }
  std::sort(of_models.begin(), of_models.end());
  for (ModelManifold begin = of_models.begin(), end = begin; begin != of_models.end(); begin = end) {
    while (end != of_models.end() && end->first == begin->first) ++end;
    applyBudget(begin, end, budgets[begin->first].max_contacts, buffers);
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
int prepare(const contact::ContactManifold& manifold, int limit, const Reduction& method, const ContactIds& chosen_before,
            ReductionBuffers* buffers, ThinnedContacts* thinned, std::vector<contact::Contact>* reduced) {
  const bool in_steps = method.reduce == static_cast<ReduceFunction>(reduceHull) && !hasPierced(manifold.contacts);
  if (in_steps && thinToHulls(manifold.contacts, limit, thinned)) return std::min(limit, static_cast<int>(thinned->kept.size()));
  thinned->kept.clear();
  reduceContacts(manifold.contacts, limit, method, chosen_before, buffers, reduced);
  return static_cast<int>(reduced->size());
}

// Chooses within the limit, at least 1 where there are contacts. @return largest lack of those kept in any wrench
float finish(const contact::ContactManifold& manifold, int limit, const Reduction& method, const ContactIds& chosen_before,
             const ThinnedContacts& thinned, ReductionBuffers* buffers, std::vector<contact::Contact>* reduced) {
  if (!thinned.kept.empty()) return chooseFromHulls(manifold.contacts, thinned, limit, chosen_before, reduced);
  if (limit < static_cast<int>(reduced->size())) {
    buffers->again = *reduced;
    reduceContacts(buffers->again, limit, method, chosen_before, buffers, reduced);
  }
  const bool all = reduced->size() == manifold.contacts.size();
  return all || hasPierced(manifold.contacts) ? 0 : wrenchLack(manifold.contacts, *reduced);
}

// Whether a pair has fewer contacts than it would have without a limit.
bool isCut(const contact::ContactManifold& manifold, int limit, const ThinnedContacts& thinned,
           const std::vector<contact::Contact>& reduced) {
  if (!thinned.kept.empty()) return reduced.size() < thinned.kept.size();
  return static_cast<int>(manifold.contacts.size()) > limit;
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

void reduceNone(const std::vector<contact::Contact>& contacts, int, const ContactIds&, std::vector<contact::Contact>* reduced) {
  *reduced = contacts;
  contact::makeCanonical(*reduced);
}

ReductionLoss reduceManifolds(const std::vector<contact::ContactManifold>& manifolds, const std::vector<int>& model_a,
                              const std::vector<int>& model_b, const std::vector<ContactBudget>& budgets, const Reduction& method,
                              ReductionMemory* memory, std::vector<contact::ContactManifold>* reduced) {
  static thread_local ReductionBuffers buffers;
  const bool all = method.reduce == reduceNone;
  const int count = static_cast<int>(manifolds.size());
  buffers.limits.resize(count);
  buffers.sizes.resize(count);
  if (static_cast<int>(buffers.thinned.size()) < count) buffers.thinned.resize(count);
  reduced->resize(count);
  for (int m = 0; m < count; ++m) {
    copyAllButContacts(manifolds[m], &(*reduced)[m]);
    buffers.limits[m] = all ? INT_MAX : std::min(budgets[model_a[m]].max_contacts, budgets[model_b[m]].max_contacts);
    buffers.sizes[m] =
        prepare(manifolds[m], buffers.limits[m], method, memory->of(manifolds[m]), &buffers, &buffers.thinned[m], &(*reduced)[m].contacts);
  }
  if (all) return {};
  applyBudgets(model_a, model_b, budgets, &buffers);
  ReductionLoss loss;
  for (int m = 0; m < count; ++m) {
    std::vector<contact::Contact>& kept = (*reduced)[m].contacts;
    const float lack = finish(manifolds[m], buffers.limits[m], method, memory->of(manifolds[m]), buffers.thinned[m], &buffers, &kept);
    if (!isCut(manifolds[m], buffers.limits[m], buffers.thinned[m], kept)) continue;
    ++loss.cut_pairs;
    loss.wrench = std::max(loss.wrench, static_cast<double>(lack));
  }
  memory->remember(*reduced);
  loss.contacts = countContacts(manifolds) - countContacts(*reduced);
  return loss;
}

}  // namespace blem_sim::reduction
