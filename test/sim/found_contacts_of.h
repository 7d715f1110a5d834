// Contacts of a state, made by hand.
#pragma once

#include <utility>
#include <vector>

#include "contacts/search/found_contacts.h"

namespace blem_sim::sim {

/** @param manifolds sorted by (a, b) */
inline FoundContacts foundContactsOf(std::vector<contact::ContactManifold> manifolds) {
  FoundContacts found;
  for (const contact::ContactManifold& manifold : manifolds) found.depths.push_back(manifold.maxDepth());
  found.manifolds = std::move(manifolds);
  return found;
}

}  // namespace blem_sim::sim
