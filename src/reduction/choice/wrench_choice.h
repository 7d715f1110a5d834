// Choice of the k contacts that span the wrenches of all of them best.
#pragma once

#include <vector>

#include "blem_sim/reduction/reduction.h"
#include "patches/patch_frame.h"

namespace blem_sim::reduction {

/**
 * Chooses at most k contacts: the deepest, then greedily the extreme contact of that fixed 6-D wrench direction in which the contacts
 * chosen so far lack most; then, with the rest of k, the same where depth counts too, and at last the deepest. Contacts that do not touch
 * yet stand back.
 * A choice made before is gone on with, completed by the same rule, while it spans nearly as much as a fresh one: among equals no noise
 * decides anew from step to step.
 * The result depends on the sets given only, not on their order.
 * Precondition: k >= 1, candidates are there, the deepest of the members among them.
 * @param members indices of the contacts to choose from @param scale of all contacts
 * @param candidates those of the members that may be extreme; reordered
 * @param chosen overwritten by indices
 * @return lack of those chosen in the candidates' wrenches, in the direction that lacks most, of a unit force; lengths in the scale's
 * radius
 */
float chooseSpanningContacts(const std::vector<contact::Contact>& contacts, const std::vector<int>& members, const PatchScale& scale, int k,
                             const ContactIds& chosen_before, std::vector<int>* candidates, std::vector<int>* chosen);

/** Lack of `kept`, as chooseSpanningContacts tells it, in the wrenches of all contacts. @return 1 if some contact is not sound */
float wrenchLack(const std::vector<contact::Contact>& all, const std::vector<contact::Contact>& kept);

}  // namespace blem_sim::reduction
