// Extremes, never averages: an average of contacts lies inside their support polygon and shrinks it.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "blem_sim/contact/contact_order.h"
#include "blem_sim/geometry/roomy.h"
#include "blem_sim/reduction/reduction.h"
#include "hull_stages.h"
#include "reduction_room.h"

namespace blem_sim::reduction {

namespace {

constexpr double STAIR = 1e-3;      // [m] parallel patches with this much air between their heights are two patches
constexpr std::size_t CROWD = 100;  // more than this many contacts are thinned before the choice, to save time,
constexpr int FEW = 100;            // if no more than this many are chosen

// Whether parallel patches lie among these: then some gap between one height and the next is wider than STAIR.
bool mayHaveStairs(const std::vector<double>& heights) {
  const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.end());
  const double low = *lowest, high = *highest;
  if (high - low <= STAIR) return false;
  // A height that is within STAIR of both leaves no such gap on either side.
  return std::none_of(heights.begin(), heights.end(), [&](double height) { return height - low <= STAIR && high - height <= STAIR; });
}

// Appends the hull of every patch among contacts of one cell, two at least. Reorders the members.
void keepHullsOfCell(const std::vector<contact::Contact>& contacts, int cell, HullRoom* room, std::vector<int>* kept) {
  int *const begin = room->cells.begin(cell), *const end = room->cells.end(cell);
  const Vector3 normal = room->cells.normal(cell);
  std::vector<double>& heights = room->heights;
  heights.clear();
  for (const int* member = begin; member != end; ++member) heights.push_back(normal.dot(contacts[*member].point));
  if (!mayHaveStairs(heights)) return patchHull({contacts, begin, end}, normal, &room->patch, kept);
  std::vector<std::pair<double, int>>& stairs = room->stairs;
  stairs.clear();
  for (const int* member = begin; member != end; ++member) stairs.emplace_back(heights[member - begin], *member);
  std::sort(stairs.begin(), stairs.end());
  int* patch = begin;
  for (std::size_t i = 0; i < stairs.size(); ++i) {
    begin[i] = stairs[i].second;
    if (i + 1 < stairs.size() && stairs[i + 1].first - stairs[i].first <= STAIR) continue;
    int* patch_end = begin + i + 1;
    patchHull({contacts, patch, patch_end}, normal, &room->patch, kept);
    patch = patch_end;
  }
}

// Keeps the hull of each patch of equal normals; all contacts where normals are too many for patches to matter.
void keepPatchHulls(const std::vector<contact::Contact>& contacts, HullRoom* room, std::vector<int>* kept) {
  NormalCells& cells = room->cells;
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
      keepHullsOfCell(contacts, cell, room, kept);
    }
  }
}

float choose(const HullChoice& asked, HullRoom* room) {
  const ThinnedContacts& thinned = asked.thinned;
  const ChoiceQuestion question{asked.contacts, thinned.kept, thinned.scale, asked.k, asked.chosen_before};
  if (thinned.kept.size() > CROWD && asked.k <= FEW) {
    room->crowd.thin(question, &room->candidates);
  } else {
    if (surelyGoesOn(question, &room->before, &room->chosen)) return GOOD_ENOUGH;
    room->candidates = thinned.kept;
  }
  return room->choice.choose(question, &room->candidates, &room->chosen);
}

}  // namespace

bool thinToHulls(const std::vector<contact::Contact>& contacts, HullRoom* room, ThinnedContacts* thinned) {
  bool ready = true;
  thinned->scale = PatchScale(contacts, &ready);
  if (ready) keepPatchHulls(contacts, room, &thinned->kept);
  return ready;
}

float chooseFromHulls(const HullChoice& asked, HullRoom* room, std::vector<contact::Contact>* reduced) {
  const std::vector<int>& kept = asked.thinned.kept;
  const bool few = static_cast<int>(kept.size()) <= asked.k;
  geometry::makeRoomFor(kept.size(), &room->chosen);
  if (few) room->chosen = kept;
  const float lack = few ? 0 : choose(asked, room);
  room->order.sort(asked.contacts, &room->chosen);
  reduced->clear();
  for (const int i : room->chosen) reduced->push_back(asked.contacts[i]);
  return lack;
}

void reduceHull(const std::vector<contact::Contact>& contacts, int k, const ContactIds& chosen_before, ReductionWorkspace* workspace,
                std::vector<contact::Contact>* reduced) {
  HullRoom* const room = &(*workspace)->hull;
  ThinnedContacts& thinned = room->thinned;
  if (thinToHulls(contacts, room, &thinned)) {
    chooseFromHulls({contacts, thinned, k, chosen_before}, room, reduced);
    return;
  }
  std::vector<contact::Contact>& usable = room->usable;
  usable = contacts;
  contact::makeUsable(usable);
  bool ready = true;
  thinned.scale = PatchScale(usable, &ready);
  keepPatchHulls(usable, room, &thinned.kept);
  chooseFromHulls({usable, thinned, k, chosen_before}, room, reduced);
}

void reduceHull(std::vector<contact::Contact>& contacts, int k, const ContactIds& chosen_before) {
  const std::vector<contact::Contact> all = contacts;
  ReductionWorkspace workspace;
  reduceHull(all, k, chosen_before, &workspace, &contacts);
}

}  // namespace blem_sim::reduction
