// Extremes, never averages: an average of contacts lies inside their support polygon and shrinks it.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "blem_sim/contact/reduction.h"
#include "contact_order.h"
#include "crowd.h"
#include "normal_cells.h"
#include "patch_hull.h"
#include "wrench_choice.h"

namespace blem_sim {

namespace {

constexpr double STAIR = 1e-3;      // [m] parallel patches with this much air between their heights are two patches
constexpr std::size_t CROWD = 100;  // more than this many contacts are thinned before the choice, to save time,
constexpr int FEW = 100;            // if no more than this many are chosen

struct Buffers {
  std::vector<Contact> usable;
  NormalCells cells;
  std::vector<std::pair<double, int>> heights;
  std::vector<int> kept, candidates, chosen;
};

// Appends the hull of every patch among contacts of one cell. Reorders the members.
void keepHullsOfCell(const std::vector<Contact>& contacts, int* begin, int* end, const Vector3& normal, Buffers* buffers) {
  double lowest = normal.dot(contacts[*begin].point), highest = lowest;
  for (const int* member = begin; member != end; ++member) {
    const double height = normal.dot(contacts[*member].point);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  if (highest - lowest <= STAIR) return patchHull(contacts, begin, end, normal, &buffers->kept);
  std::vector<std::pair<double, int>>& heights = buffers->heights;
  heights.clear();
  for (const int* member = begin; member != end; ++member) heights.emplace_back(normal.dot(contacts[*member].point), *member);
  std::sort(heights.begin(), heights.end());
  int* patch = begin;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    begin[i] = heights[i].second;
    if (i + 1 < heights.size() && heights[i + 1].first - heights[i].first <= STAIR) continue;
    int* patch_end = begin + i + 1;
    patchHull(contacts, patch, patch_end, normal, &buffers->kept);
    patch = patch_end;
  }
}

// All contacts, but of each patch of equal normals its hull; where normals are too many for patches to matter, all of them.
void keepPatchHulls(const std::vector<Contact>& contacts, Buffers* buffers) {
  if (!buffers->cells.group(contacts)) {
    buffers->kept.resize(contacts.size());
    std::iota(buffers->kept.begin(), buffers->kept.end(), 0);
    return;
  }
  buffers->kept.clear();
  for (int cell = 0; cell < buffers->cells.count(); ++cell)
    keepHullsOfCell(contacts, buffers->cells.begin(cell), buffers->cells.end(cell), buffers->cells.normal(cell), buffers);
}

const std::vector<int>& choose(const std::vector<Contact>& contacts, const PatchScale& scale, int k, const ContactIds& chosen_before,
                               Buffers* buffers) {
  if (buffers->kept.size() > CROWD && k <= FEW) {
    thinCrowd(contacts, scale, buffers->kept, chosen_before, &buffers->candidates);
  } else {
    buffers->candidates = buffers->kept;
  }
  chooseSpanningContacts(contacts, buffers->kept, scale, k, chosen_before, &buffers->candidates, &buffers->chosen);
  return buffers->chosen;
}

void reduceUsable(const std::vector<Contact>& usable, const PatchScale& scale, int k, const ContactIds& chosen_before, Buffers* buffers,
                  std::vector<Contact>* reduced) {
  keepPatchHulls(usable, buffers);
  const bool few = static_cast<int>(buffers->kept.size()) <= k;
  const std::vector<int>& kept = few ? buffers->kept : choose(usable, scale, k, chosen_before, buffers);
  reduced->clear();
  for (const int i : kept) reduced->push_back(usable[i]);
  std::sort(reduced->begin(), reduced->end(), contactBefore);
}

}  // namespace

void reduceHull(const std::vector<Contact>& contacts, int k, const ContactIds& chosen_before, std::vector<Contact>* reduced) {
  static thread_local Buffers buffers;
  bool ready = true;
  const PatchScale scale(contacts, &ready);
  if (ready) return reduceUsable(contacts, scale, k, chosen_before, &buffers, reduced);
  buffers.usable = contacts;
  makeUsable(buffers.usable);
  reduceUsable(buffers.usable, PatchScale(buffers.usable, &ready), k, chosen_before, &buffers, reduced);
}

void reduceHull(std::vector<Contact>& contacts, int k, const ContactIds& chosen_before) {
  const std::vector<Contact> all = contacts;
  reduceHull(all, k, chosen_before, &contacts);
}

}  // namespace blem_sim
