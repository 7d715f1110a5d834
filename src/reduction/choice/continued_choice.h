// Continuation of an earlier choice of contacts.
#pragma once

#include <vector>

#include "blem_sim/reduction/reduction.h"
#include "patches/patch_frame.h"

namespace blem_sim::reduction {

// Lack that an earlier choice may have beyond a fresh one, in the direction that lacks most, of a unit force; and [m] in depth.
constexpr float GOOD_ENOUGH = 0.05f;
constexpr double DEEP_ENOUGH = 1e-6;

/**
 * Whether k contacts chosen before are surely chosen again, told from places instead of wrenches: all are there, they are as deep as any,
 * and every other member lies so near to one of them, or to the line between two neighbours, that it adds no more than GOOD_ENOUGH in any
 * direction. Members lie on such lines where they follow around the hull of a patch; false says nothing.
 * @param members indices of the contacts to choose from @param scale of all contacts
 * @param chosen overwritten by indices
 */
bool surelyGoesOn(const std::vector<contact::Contact>& contacts, const std::vector<int>& members, const PatchScale& scale, int k,
                  const ContactIds& chosen_before, std::vector<int>* chosen);

}  // namespace blem_sim::reduction
