#pragma once

#include <cstddef>

#include "blem_sim/contact/manifold.h"
#include "tolerances.h"

namespace blem_sim {

/**
 * Sorts by id; contacts of one id, and contacts at one place with one normal, become the deepest of them under their smallest id.
 * Whether a contact is pierced keeps it apart from those that are not, unless they have one id: then the pierced one stays.
 * @param merged room for as many @return how many are left
 */
std::size_t mergeContacts(const Contact* contacts, std::size_t count, Contact* merged);

}  // namespace blem_sim
