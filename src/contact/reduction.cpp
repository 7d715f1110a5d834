#include "blem_sim/contact/reduction.h"

#include <algorithm>
#include <climits>
#include <map>
#include <numeric>

#include "contact_order.h"

namespace blem_sim {

namespace {

// Sound contacts take part in the choice; pierced ones, whose directions are the fallback's, get the room that is left, and a quarter of k
// if they are so many: else what crossed would stay crossed.
void reduceManifold(ContactManifold& manifold, int k, const Reduction& method, const ContactIds& chosen_before) {
  std::vector<Contact>& contacts = manifold.contacts;
  std::vector<Contact> pierced;
  const auto first_pierced = std::stable_partition(contacts.begin(), contacts.end(), [](const Contact& c) { return !c.pierced; });
  pierced.assign(first_pierced, contacts.end());
  contacts.erase(first_pierced, contacts.end());
  const int reserved = std::min(k / 4, static_cast<int>(pierced.size()));
  method.reduce(contacts, k - reserved, chosen_before);
  const int room = k - static_cast<int>(contacts.size());
  if (pierced.empty() || room <= 0) return;
  method.reduce(pierced, room, chosen_before);
  contacts.insert(contacts.end(), pierced.begin(), pierced.end());
  std::sort(contacts.begin(), contacts.end(), contactBefore);
}

/** k shared by `counts` in proportion, by largest remainders; nobody gets more than it has; each at least `floor`, if it has that. */
std::vector<int> fairShares(const std::vector<int>& counts, int k) {
  const int parties = static_cast<int>(counts.size());
  const long total = std::accumulate(counts.begin(), counts.end(), 0L);
  const int floor = 3L * parties <= k ? 3 : (parties <= k ? 1 : 0);
  std::vector<int> shares(parties);
  std::vector<std::pair<long, int>> remainders;  // negative, so that the largest comes first
  for (int i = 0; i < parties; ++i) {
    const long part = static_cast<long>(k) * counts[i];
    shares[i] = std::max(static_cast<int>(part / total), std::min(floor, counts[i]));
    remainders.push_back({-(part % total), i});
  }
  std::sort(remainders.begin(), remainders.end());
  int left = k - std::accumulate(shares.begin(), shares.end(), 0);
  for (std::size_t i = 0; i < remainders.size() && left > 0; ++i) {
    const int party = remainders[i].second;
    if (shares[party] >= counts[party]) continue;
    ++shares[party];
    --left;
  }
  // The floors may have overdrawn: the largest give back, one at a time.
  for (; left < 0; ++left) --*std::max_element(shares.begin(), shares.end());
  return shares;
}

// Where a model has more contacts than its k, lowers the limits of its manifolds to their shares.
void applyBudget(const std::vector<ContactManifold>& manifolds, const std::vector<int>& of_model, int k, std::vector<int>& limits) {
  std::vector<int> counts, touching;
  int total = 0;
  for (int m : of_model) {
    const int count = std::min(limits[m], static_cast<int>(manifolds[m].contacts.size()));
    if (count == 0) continue;
    touching.push_back(m);
    counts.push_back(count);
    total += count;
  }
  if (total <= k) return;
  const std::vector<int> shares = fairShares(counts, k);
  for (std::size_t i = 0; i < touching.size(); ++i) limits[touching[i]] = std::min(limits[touching[i]], shares[i]);
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

void reduceNone(std::vector<Contact>& contacts, int, const ContactIds&) { makeCanonical(contacts); }

int reduceManifolds(std::vector<ContactManifold>& manifolds, const std::vector<int>& model_a, const std::vector<int>& model_b,
                    const std::vector<ContactBudget>& budgets, const Reduction& method, ReductionMemory* memory) {
  const int before = countContacts(manifolds);
  const int count = static_cast<int>(manifolds.size());
  if (method.reduce == reduceNone) {
    for (ContactManifold& manifold : manifolds) reduceNone(manifold.contacts, INT_MAX, {});
    return before - countContacts(manifolds);
  }
  std::map<int, std::vector<int>> manifolds_of;
  for (int m = 0; m < count; ++m) {
    manifolds_of[model_a[m]].push_back(m);
    if (model_b[m] != model_a[m]) manifolds_of[model_b[m]].push_back(m);
  }

  std::vector<int> limits(count);
  for (int m = 0; m < count; ++m) {
    limits[m] = std::min(budgets[model_a[m]].max_contacts, budgets[model_b[m]].max_contacts);
    reduceManifold(manifolds[m], limits[m], method, memory->of(manifolds[m]));
  }
  for (const auto& [model, of_model] : manifolds_of) applyBudget(manifolds, of_model, budgets[model].max_contacts, limits);
  for (int m = 0; m < count; ++m) {
    if (limits[m] >= static_cast<int>(manifolds[m].contacts.size())) continue;
    if (limits[m] == 0) {
      manifolds[m].contacts.clear();
    } else {
      reduceManifold(manifolds[m], limits[m], method, memory->of(manifolds[m]));
    }
  }
  memory->remember(manifolds);
  return before - countContacts(manifolds);
}

}  // namespace blem_sim
