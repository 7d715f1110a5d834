// Contacts of one flat patch: those that say everything the others say.
#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"

namespace blem_sim {

/**
 * Indices of the contacts to keep, a subset of `members`, for contacts with (nearly) one normal: the corners of the convex hull of
 * their points in the plane across `normal`, and contacts deeper than what the kept ones' depths interpolate to. The constraint of
 * every contact left out is a convex combination of kept ones' or weaker, so no wrench is lost [Hauser 2013, 5].
 * The result depends on the set of members only, not on their order.
 * @param contacts in canonical order (contact_order.h): an index decides ties
 */
std::vector<int> patchHull(const std::vector<Contact>& contacts, const std::vector<int>& members, const Vector3& normal);

}  // namespace blem_sim
