// Room of all stages of a reduction.
#pragma once

#include <utility>
#include <vector>

#include "blem_sim/contact/contact_order.h"
#include "blem_sim/reduction/reduction.h"
#include "choice/continued_choice.h"
#include "choice/crowd.h"
#include "choice/wrench_choice.h"
#include "hull_stages.h"
#include "patches/normal_cells.h"
#include "patches/patch_hull.h"
#include "spring_rows.h"

namespace blem_sim::reduction {

/** Room of budgets: several manifolds that are reduced together. */
struct BudgetRoom {
  std::vector<contact::Contact> sound, pierced, more, again;
  std::vector<ThinnedContacts> thinned;  ///< manifold by manifold
  std::vector<int> limits, sizes;        ///< manifold by manifold: numbers of contacts that may be kept, and would be
  std::vector<float> lacks;              ///< manifold by manifold: largest lack of what is kept in any wrench
  std::vector<int> touching, counts, shares;
  std::vector<std::pair<int, int>> of_models;  ///< (model, manifold)
  std::vector<std::pair<int, int>> order;      ///< (count, party)
};

/** Room of `hull`: patches of one manifold, and the choice among what is left. */
struct HullRoom {
  NormalCells cells;
  std::vector<double> heights;
  std::vector<std::pair<double, int>> stairs;
  PatchHullRoom patch;
  ThinnedContacts thinned;  // where no budgets are shared out in between
  std::vector<contact::Contact> usable;
  std::vector<int> candidates, chosen;
  ChosenBefore before;
  CrowdThinner crowd;
  WrenchChoice choice;
  contact::CanonicalOrder order;
};

struct ReductionWorkspace::Room {
  BudgetRoom budgets;
  HullRoom hull;
  SpringRoom springs;
  std::vector<ReductionWorkspace> of_threads;  ///< of others that reduce manifolds at the same time
};

}  // namespace blem_sim::reduction
