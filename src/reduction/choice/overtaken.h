// Contacts that cannot be chosen, told before their wrenches are worked out.
#pragma once

#include <vector>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/reduction/reduction.h"
#include "lanes/reduction_lanes.h"

namespace blem_sim::reduction {

/**
 * Leaves out candidates whose wrenches, less their handicaps, others exceed in every direction: contacts that do not touch yet beside
 * others that do, or nearly. Those left are as extreme as all were.
 * @param spared ids of candidates to keep whatever others exceed
 * @param candidates indices of contacts, sorted by id @param points theirs
 */
void dropOvertaken(const std::vector<contact::Contact>& contacts, const ContactIds& spared, std::vector<int>* candidates,
                   std::vector<WrenchPoint>* points);

}  // namespace blem_sim::reduction
