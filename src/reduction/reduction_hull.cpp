// Extremes, never averages: an average of contacts lies inside their support polygon and shrinks it.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "blem_sim/contact/contact_order.h"
#include "blem_sim/geometry/roomy.h"
#include "blem_sim/reduction/reduction.h"
#include "choice/continued_choice.h"
#include "choice/crowd.h"
#include "choice/wrench_choice.h"
#include "hull_stages.h"
#include "patches/normal_cells.h"
#include "patches/patch_hull.h"

namespace blem_sim::reduction {

namespace {

constexpr double STAIR = 1e-3;      // [m] parallel patches with this much air between their heights are two patches
constexpr std::size_t CROWD = 100;  // more than this many contacts are thinned before the choice, to save time,
constexpr int FEW = 100;            // if no more than this many are chosen

struct PatchBuffers {
  NormalCells cells;
  std::vector<double> heights;
  std::vector<std::pair<double, int>> stairs;
  std::vector<int> candidates, chosen;
};

PatchBuffers& threadBuffers() {
  static thread_local PatchBuffers buffers;
  return buffers;
}

// Whether parallel patches lie among these: then some gap between one height and the next is wider than STAIR.
bool mayHaveStairs(const std::vector<double>& heights) {
  const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.end());
  const double low = *lowest, high = *highest;
  if (high - low <= STAIR) return false;
  // A height that is within STAIR of both leaves no such gap on either side.
  return std::none_of(heights.begin(), heights.end(), [&](double height) { return height - low <= STAIR && high - height <= STAIR; });
}

// Appends the hull of every patch among contacts of one cell, two at least. Reorders the members.
void keepHullsOfCell(const std::vector<contact::Contact>& contacts, int* begin, int* end, const Vector3& normal, int k,
                     PatchBuffers* buffers, std::vector<int>* kept) {
  std::vector<double>& heights = buffers->heights;
  heights.clear();
  for (const int* member = begin; member != end; ++member) heights.push_back(normal.dot(contacts[*member].point));
  if (!mayHaveStairs(heights)) return patchHull(contacts, begin, end, normal, k, kept);
  std::vector<std::pair<double, int>>& stairs = buffers->stairs;
  stairs.clear();
  for (const int* member = begin; member != end; ++member) stairs.emplace_back(heights[member - begin], *member);
  std::sort(stairs.begin(), stairs.end());
  int* patch = begin;
  for (std::size_t i = 0; i < stairs.size(); ++i) {
    begin[i] = stairs[i].second;
    if (i + 1 < stairs.size() && stairs[i + 1].first - stairs[i].first <= STAIR) continue;
    int* patch_end = begin + i + 1;
    patchHull(contacts, patch, patch_end, normal, k, kept);
    patch = patch_end;
  }
}

// Keeps the hull of each patch of equal normals; all contacts where normals are too many for patches to matter.
void keepPatchHulls(const std::vector<contact::Contact>& contacts, int k, PatchBuffers* buffers, std::vector<int>* kept) {
  NormalCells& cells = buffers->cells;
  if (!cells.group(contacts)) {
    kept->resize(contacts.size());
    std::iota(kept->begin(), kept->end(), 0);
    return;
  }
  kept->clear();
  for (int cell = 0; cell < cells.count(); ++cell) {
    if (cells.end(cell) - cells.begin(cell) == 1) {
      kept->push_back(*cells.begin(cell));
    } else {
      keepHullsOfCell(contacts, cells.begin(cell), cells.end(cell), cells.normal(cell), k, buffers, kept);
    }
  }
}

float choose(const std::vector<contact::Contact>& contacts, const ThinnedContacts& thinned, int k, const ContactIds& chosen_before,
             PatchBuffers* buffers) {
  if (thinned.kept.size() > CROWD && k <= FEW) {
    thinCrowd(contacts, thinned.scale, thinned.kept, chosen_before, &buffers->candidates);
  } else {
    if (surelyGoesOn(contacts, thinned.kept, thinned.scale, k, chosen_before, &buffers->chosen)) return GOOD_ENOUGH;
    buffers->candidates = thinned.kept;
  }
  return chooseSpanningContacts(contacts, thinned.kept, thinned.scale, k, chosen_before, &buffers->candidates, &buffers->chosen);
}

}  // namespace

bool thinToHulls(const std::vector<contact::Contact>& contacts, int k, ThinnedContacts* thinned) {
  bool ready = true;
  thinned->scale = PatchScale(contacts, &ready);
  if (ready) keepPatchHulls(contacts, k, &threadBuffers(), &thinned->kept);
  return ready;
}

float chooseFromHulls(const std::vector<contact::Contact>& contacts, const ThinnedContacts& thinned, int k, const ContactIds& chosen_before,
                      std::vector<contact::Contact>* reduced) {
  const bool few = static_cast<int>(thinned.kept.size()) <= k;
  PatchBuffers& buffers = threadBuffers();
  geometry::makeRoomFor(thinned.kept.size(), &buffers.chosen);
  if (few) buffers.chosen = thinned.kept;
  const float lack = few ? 0 : choose(contacts, thinned, k, chosen_before, &buffers);
  contact::sortCanonically(contacts, &buffers.chosen);
  reduced->clear();
  for (const int i : buffers.chosen) reduced->push_back(contacts[i]);
  return lack;
}

void reduceHull(const std::vector<contact::Contact>& contacts, int k, const ContactIds& chosen_before,
                std::vector<contact::Contact>* reduced) {
  static thread_local ThinnedContacts thinned;
  if (thinToHulls(contacts, k, &thinned)) {
    chooseFromHulls(contacts, thinned, k, chosen_before, reduced);
    return;
  }
  static thread_local std::vector<contact::Contact> usable;
  usable = contacts;
  contact::makeUsable(usable);
  bool ready = true;
  thinned.scale = PatchScale(usable, &ready);
  keepPatchHulls(usable, k, &threadBuffers(), &thinned.kept);
  chooseFromHulls(usable, thinned, k, chosen_before, reduced);
}

void reduceHull(std::vector<contact::Contact>& contacts, int k, const ContactIds& chosen_before) {
  const std::vector<contact::Contact> all = contacts;
  reduceHull(all, k, chosen_before, &contacts);
}

}  // namespace blem_sim::reduction
