// A choice of contacts that is to be made.
#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/reduction/reduction.h"
#include "patches/patch_frame.h"

namespace blem_sim::reduction {

/** Contacts of a pair of which k are to be chosen. */
struct ChoiceQuestion {
  const std::vector<contact::Contact>& contacts;
  const std::vector<int>& members;  ///< indices of the contacts to choose from
  const PatchScale& scale;          ///< of all contacts
  int k;                            ///< at least 1
  const ContactIds& chosen_before;  ///< of the same pair in the step before
};

}  // namespace blem_sim::reduction
