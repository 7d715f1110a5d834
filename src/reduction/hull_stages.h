// The reduction "hull" in its two steps, so that budgets can be shared out in between.
#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/reduction/reduction.h"
#include "patches/patch_frame.h"

namespace blem_sim::reduction {

struct HullRoom;

/** Contacts that imply all others of a set. */
struct ThinnedContacts {
  PatchScale scale;
  std::vector<int> kept;  ///< indices
};

/** A choice among thinned contacts. */
struct HullChoice {
  const std::vector<contact::Contact>& contacts;
  const ThinnedContacts& thinned;
  int k;
  const ContactIds& chosen_before;
};

/** Leaves out contacts that the corners of flat patches imply. @return false if some contact is not finite or its normal not unit: nothing
 * is done */
bool thinToHulls(const std::vector<contact::Contact>& contacts, HullRoom* room, ThinnedContacts* thinned);

/** Chooses all thinned contacts, or k of them that span the wrenches best. @param reduced overwritten; sorted by id
 * @return largest lack of the choice in any wrench, as WrenchChoice tells it; 0 if nothing is left out */
float chooseFromHulls(const HullChoice& asked, HullRoom* room, std::vector<contact::Contact>* reduced);

}  // namespace blem_sim::reduction
