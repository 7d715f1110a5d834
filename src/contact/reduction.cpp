#include "blem_sim/contact/reduction.h"

#include <algorithm>
#include <climits>
#include <numeric>

#include "contact_order.h"

namespace blem_sim {

namespace {

// Kept between calls.
struct Buffers {
  std::vector<Contact> sound, pierced, more, again;
  std::vector<int> limits, touching, counts, shares;
  std::vector<std::pair<int, int>> of_models;    // (model, manifold)
  std::vector<std::pair<long, int>> remainders;  // negative, so that the largest comes first
};

// Sound contacts take part in the choice; pierced ones, whose directions are the fallback's, get the room that is left, and a quarter of k
// if they are so many: else what crossed would stay crossed.
void reduceContacts(const std::vector<Contact>& contacts, int k, const Reduction& method, const ContactIds& chosen_before, Buffers* buffers,
                    std::vector<Contact>* reduced) {
  const auto is_pierced = [](const Contact& c) { return c.pierced; };
  if (std::none_of(contacts.begin(), contacts.end(), is_pierced)) return method.reduce(contacts, k, chosen_before, reduced);
  buffers->sound.clear();
  buffers->pierced.clear();
  for (const Contact& contact : contacts) (contact.pierced ? buffers->pierced : buffers->sound).push_back(contact);
  const int reserved = std::min(k / 4, static_cast<int>(buffers->pierced.size()));
  method.reduce(buffers->sound, k - reserved, chosen_before, reduced);
  const int room = k - static_cast<int>(reduced->size());
  if (room <= 0) return;
  method.reduce(buffers->pierced, room, chosen_before, &buffers->more);
  reduced->insert(reduced->end(), buffers->more.begin(), buffers->more.end());
  std::sort(reduced->begin(), reduced->end(), contactBefore);
}

/** k shared by `counts` in proportion, by largest remainders; nobody gets more than it has; each at least `floor`, if it has that. */
void fairShares(int k, Buffers* buffers) {
  const std::vector<int>& counts = buffers->counts;
  std::vector<int>& shares = buffers->shares;
  const int parties = static_cast<int>(counts.size());
  const long total = std::accumulate(counts.begin(), counts.end(), 0L);
  const int floor = 3L * parties <= k ? 3 : (parties <= k ? 1 : 0);
  shares.resize(parties);
  buffers->remainders.clear();
  for (int i = 0; i < parties; ++i) {
    const long part = static_cast<long>(k) * counts[i];
    shares[i] = std::max(static_cast<int>(part / total), std::min(floor, counts[i]));
    buffers->remainders.push_back({-(part % total), i});
  }
  std::sort(buffers->remainders.begin(), buffers->remainders.end());
  int left = k - std::accumulate(shares.begin(), shares.end(), 0);
  for (std::size_t i = 0; i < buffers->remainders.size() && left > 0; ++i) {
    const int party = buffers->remainders[i].second;
    if (shares[party] >= counts[party]) continue;
    ++shares[party];
    --left;
  }
  // The floors may have overdrawn: the largest give back, one at a time.
  for (; left < 0; ++left) --*std::max_element(shares.begin(), shares.end());
}

using ModelManifold = std::vector<std::pair<int, int>>::const_iterator;

// Where a model has more contacts than its k, lowers the limits of its manifolds to their shares.
void applyBudget(const std::vector<ContactManifold>& reduced, ModelManifold begin, ModelManifold end, int k, Buffers* buffers) {
  std::vector<int>&limits = buffers->limits, &touching = buffers->touching;
  touching.clear();
  buffers->counts.clear();
  int total = 0;
  for (ModelManifold of_model = begin; of_model != end; ++of_model) {
    const int m = of_model->second;
    const int count = std::min(limits[m], static_cast<int>(reduced[m].contacts.size()));
    if (count == 0) continue;
    touching.push_back(m);
    buffers->counts.push_back(count);
    total += count;
  }
  if (total <= k) return;
  fairShares(k, buffers);
  for (std::size_t i = 0; i < touching.size(); ++i) limits[touching[i]] = std::min(limits[touching[i]], buffers->shares[i]);
}

// Lowers limits until every model keeps to its budget.
void applyBudgets(const std::vector<ContactManifold>& reduced, const std::vector<int>& model_a, const std::vector<int>& model_b,
                  const std::vector<ContactBudget>& budgets, Buffers* buffers) {
  std::vector<std::pair<int, int>>& of_models = buffers->of_models;
  of_models.clear();
  for (int m = 0; m < static_cast<int>(reduced.size()); ++m) {
    of_models.push_back({model_a[m], m});
    if (model_b[m] != model_a[m]) of_models.push_back({model_b[m], m});
  }
  std::sort(of_models.begin(), of_models.end());
  for (ModelManifold begin = of_models.begin(), end = begin; begin != of_models.end(); begin = end) {
    while (end != of_models.end() && end->first == begin->first) ++end;
    applyBudget(reduced, begin, end, budgets[begin->first].max_contacts, buffers);
  }
}

int countContacts(const std::vector<ContactManifold>& manifolds) {
  int count = 0;
  for (const ContactManifold& manifold : manifolds) count += static_cast<int>(manifold.contacts.size());
  return count;
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

void reduceNone(const std::vector<Contact>& contacts, int, const ContactIds&, std::vector<Contact>* reduced) {
  *reduced = contacts;
  makeCanonical(*reduced);
}

int reduceManifolds(const std::vector<ContactManifold>& manifolds, const std::vector<int>& model_a, const std::vector<int>& model_b,
                    const std::vector<ContactBudget>& budgets, const Reduction& method, ReductionMemory* memory,
                    std::vector<ContactManifold>* reduced) {
  static thread_local Buffers buffers;
  const bool all = method.reduce == reduceNone;
  const int count = static_cast<int>(manifolds.size());
  buffers.limits.resize(count);
  reduced->resize(count);
  for (int m = 0; m < count; ++m) {
    ContactManifold& kept = (*reduced)[m];
    kept.a = manifolds[m].a;
    kept.b = manifolds[m].b;
    kept.layer = manifolds[m].layer;
    kept.pierced = manifolds[m].pierced;
    buffers.limits[m] = all ? INT_MAX : std::min(budgets[model_a[m]].max_contacts, budgets[model_b[m]].max_contacts);
    reduceContacts(manifolds[m].contacts, buffers.limits[m], method, memory->of(manifolds[m]), &buffers, &kept.contacts);
  }
  if (all) return countContacts(manifolds) - countContacts(*reduced);

  applyBudgets(*reduced, model_a, model_b, budgets, &buffers);
  for (int m = 0; m < count; ++m) {
    std::vector<Contact>& kept = (*reduced)[m].contacts;
    if (buffers.limits[m] >= static_cast<int>(kept.size())) continue;
    buffers.again = kept;
    kept.clear();
    if (buffers.limits[m] > 0) reduceContacts(buffers.again, buffers.limits[m], method, memory->of(manifolds[m]), &buffers, &kept);
  }
  memory->remember(*reduced);
  return countContacts(manifolds) - countContacts(*reduced);
}

}  // namespace blem_sim
