#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"
#include "tolerances.h"

namespace blem_sim {

/**
 * Sorts by id; contacts of one id, and contacts at one place with one normal, become the deepest of them under their smallest id.
 * Whether a contact is pierced keeps it apart from those that are not, unless they have one id: then the pierced one stays.
 */
void mergeContacts(std::vector<Contact>* contacts);

}  // namespace blem_sim
