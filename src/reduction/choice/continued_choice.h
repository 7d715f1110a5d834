// Continuation of an earlier choice of contacts.
#pragma once

#include <vector>

#include "choice/choice_question.h"
#include "lanes/reduction_lanes.h"
#include "lanes/wrench_bounds.h"

namespace blem_sim::reduction {

// Lack that an earlier choice may have beyond a fresh one, in the direction that lacks most, of a unit force; and [m] in depth.
constexpr float GOOD_ENOUGH = 0.05f;
constexpr double DEEP_ENOUGH = 1e-6;

/** Room of surelyGoesOn: contacts chosen before among the members. */
struct ChosenBefore {
  std::vector<int> places;  ///< in the list of members, ascending
  std::vector<WrenchPoint> points;
  WrenchPointRows rows;  ///< the same
};

/**
 * Whether k contacts chosen before are surely chosen again, told from places instead of wrenches: all are there, they are as deep as any,
 * and every other member lies so near to one of them, or to the line between two neighbours, that it adds no more than GOOD_ENOUGH in any
 * direction. Members lie on such lines where they follow around the hull of a patch; false says nothing.
 * @param chosen overwritten by indices
 */
bool surelyGoesOn(const ChoiceQuestion& asked, ChosenBefore* before, std::vector<int>* chosen);

}  // namespace blem_sim::reduction
