// Faults of a solution: what it misses, in units of the most that may be missed.
#pragma once

#include <vector>

#include "lanes/contact_term.h"
#include "newton/newton_report.h"

namespace blem_sim::dynamics {

constexpr double CREEP_IS_TROUBLE = 0.01;  // [rad/s or m/s]

/** Imbalance, creep of joints and violation of Coulomb's law, the worst of them. Above 1 is trouble; infinite if one is not a number. */
double faults(const NewtonReport& report, const std::vector<ContactTerm>& contacts);

/** Creep of contacts among them: light bodies between heavy ones creep long before they violate the law by much of the largest impulse. */
double faultsWithCreep(const NewtonReport& report, const std::vector<ContactTerm>& contacts);

}  // namespace blem_sim::dynamics
