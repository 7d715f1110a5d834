// Extremes, never averages: an average of contacts lies inside their support polygon and shrinks it.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "blem_sim/contact/reduction.h"
#include "contact_order.h"
#include "normal_cells.h"
#include "patch_hull.h"
#include "wrench_choice.h"

namespace blem_sim {

namespace {

constexpr double EQUAL_NORMALS = 1.0 / 16384;  // cell of the grid over normals in which a patch counts as flat
constexpr double ALIKE_NORMALS = 1.0 / 32;     // coarser cell for crowds of contacts on noise: about 2 degrees
constexpr double STAIR = 1e-3;                 // [m] parallel patches with this much air between their heights are two patches
constexpr std::size_t CROWD = 400;             // more than this many contacts are thinned before the choice, to save time

// Adds the hull of every patch among contacts of one cell to `kept`. Reorders the members.
void keepHullsOfCell(const std::vector<Contact>& contacts, std::vector<int>& members, const Vector3& normal, std::vector<int>& kept) {
  if (members.size() == 1) return kept.push_back(members[0]);
  const auto height = [&](int i) { return normal.dot(contacts[i].point); };
  double lowest = height(members[0]), highest = lowest;
  for (int i : members) {
    lowest = std::min(lowest, height(i));
    highest = std::max(highest, height(i));
  }
  if (highest - lowest > STAIR) {
    std::sort(members.begin(), members.end(), [&](int a, int b) { return height(a) != height(b) ? height(a) < height(b) : a < b; });
  }
  std::vector<int> patch;
  for (std::size_t i = 0; i < members.size(); ++i) {
    patch.push_back(members[i]);
    if (i + 1 < members.size() && std::abs(height(members[i + 1]) - height(members[i])) <= STAIR) continue;
    if (patch.size() > 1) patch = patchHull(contacts, patch, normal);
    kept.insert(kept.end(), patch.begin(), patch.end());
    patch.clear();
  }
}

// Replaces the contacts of every patch by its hull, but for those of these ids.
void keepPatchHulls(std::vector<Contact>& contacts, double cell, const ContactIds& spared) {
  std::vector<int> kept;
  forEachNormalCell(contacts, cell,
                    [&](std::vector<int>& members, const Vector3& normal) { keepHullsOfCell(contacts, members, normal, kept); });
  if (kept.size() == contacts.size()) return;
  std::vector<char> keep(contacts.size(), 0);
  for (int i : kept) keep[i] = 1;
  std::size_t count = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (keep[i] || std::binary_search(spared.begin(), spared.end(), contacts[i].id)) contacts[count++] = contacts[i];
  }
  contacts.resize(count);
}

}  // namespace

void reduceHull(std::vector<Contact>& contacts, int k, const ContactIds& chosen_before) {
  makeCanonical(contacts);
  keepPatchHulls(contacts, EQUAL_NORMALS, {});
  if (static_cast<int>(contacts.size()) <= k) return;
  if (contacts.size() > CROWD) keepPatchHulls(contacts, ALIKE_NORMALS, chosen_before);
  if (static_cast<int>(contacts.size()) <= k) return;
  const std::vector<int> chosen = chooseSpanningContacts(contacts, k, chosen_before);
  for (std::size_t i = 0; i < chosen.size(); ++i) contacts[i] = contacts[chosen[i]];
  contacts.resize(chosen.size());
}

}  // namespace blem_sim
