#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"

namespace blem_sim {

/** Contacts closer than this [m] with normals within this sine are one. */
constexpr double MERGE_DISTANCE = 0.2e-6;
constexpr double MERGE_SINE = 1e-3;

/**
 * Sorts by id; contacts of one id, and contacts at one place with one normal, become the deepest of them under their smallest id.
 * Whether a contact is pierced keeps it apart from those that are not, unless they have one id: then the pierced one stays.
 */
void mergeContacts(std::vector<Contact>* contacts);

}  // namespace blem_sim
