// Contacts of one flat patch: those that imply all others.
#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"

namespace blem_sim::reduction {

/**
 * Appends the contacts to keep, for contacts with (nearly) one normal: the corners of the convex hull of their points in the plane across
 * `normal`, and contacts deeper than the interpolation of the kept ones' depths. The constraint of every contact left out is a convex
 * combination of kept ones' or weaker, so no wrench is lost [Hauser 2013, 5]. The choice depends on the set of members only, not on their
 * order.
 * @param begin, end members, indices of contacts; at least one
 * @param most patches with surely more corners than this are not worth their hull: all their members are kept
 */
void patchHull(const std::vector<contact::Contact>& contacts, const int* begin, const int* end, const Vector3& normal, int most,
               std::vector<int>* kept);

}  // namespace blem_sim::reduction
