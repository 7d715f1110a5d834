// Identities of contacts, as the solver knows them (dynamics::ContactConstraint::id).
#pragma once

#include <cstdint>

namespace blem_sim::sim {

/** Identity of a contact of a pair of colliders among those of all pairs. */
std::uint64_t worldContactId(int a, int b, std::uint64_t id);

/** Identity of the stop below a contact's spring, which is another contact. @param id worldContactId of the contact */
std::uint64_t stopId(std::uint64_t id);

}  // namespace blem_sim::sim
