// Which k contacts span the wrenches of all of them best.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"

namespace blem_sim {

/**
 * Indices of at most k contacts, ascending: the deepest, then greedily the extreme contact of that fixed 6-D wrench direction in which the
 * contacts chosen so far lack most; then, with what is left of k, the same where depth counts too, and at last the deepest.
 * Contacts that do not touch yet stand back.
 * A choice made before is gone on with, completed by the same rule, while it spans nearly as much as a fresh one: among equals no noise
 * decides anew from step to step.
 * Precondition: contacts in canonical order (contact_order.h), k >= 1.
 * @param chosen_before ids, ascending
 */
std::vector<int> chooseSpanningContacts(const std::vector<Contact>& contacts, int k, const std::vector<std::uint64_t>& chosen_before);

}  // namespace blem_sim
