// Contacts of one flat patch: those that imply all others.
#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"
#include "lanes/reduction_lanes.h"
#include "patches/patch_depths.h"

namespace blem_sim::reduction {

/** Members of a patch, indices of contacts; at least one. */
struct PatchMembers {
  const std::vector<contact::Contact>& contacts;
  const int *begin, *end;
};

/** Room of patchHull: places of the members in the plane, those that may be corners, and the corners. */
struct PatchHullRoom {
  PlanePlaces places;
  std::vector<int> farthest, outside;
  PlaneExtremes extremes;
  std::vector<PlanePoint> points, half, hull, ring, corners;
  PatchDepths depths;
};

/**
 * Appends the contacts to keep, for contacts with (nearly) one normal: the corners of the convex hull of their points in the plane across
 * `normal`, and contacts deeper than the interpolation of the kept ones' depths. The constraint of every contact left out is a convex
 * combination of kept ones' or weaker, so no wrench is lost [Hauser 2013, 5]. The choice depends on the set of members only, not on their
 * order.
 */
void patchHull(const PatchMembers& members, const Vector3& normal, PatchHullRoom* room, std::vector<int>* kept);

}  // namespace blem_sim::reduction
