// A contact's numbers as vectors, for loops over many contacts.
#pragma once

#include <cstddef>
#include <cstring>

#include "blem_sim/contact/manifold.h"
#include "lanes/instruction_sets.h"

namespace blem_sim::reduction {

typedef double Doubles __attribute__((vector_size(32)));  // wider ones would be taken apart where processors have none

/** A contact's point and its normal's x; the normal's y and z, the depth and 0. */
struct ContactRow {
  Doubles first, second;
};

static_assert(offsetof(contact::Contact, point) == 0 && offsetof(contact::Contact, normal_BA) == 3 * sizeof(double) &&
                  offsetof(contact::Contact, depth) == 6 * sizeof(double) && sizeof(contact::Contact) >= sizeof(ContactRow),
              "a contact starts like a row");

BLEM_SIM_INLINE void readRow(const contact::Contact& contact, ContactRow* row) {
  typedef long Bits __attribute__((vector_size(32)));
  constexpr Bits NUMBERS = {-1, -1, -1, 0};
  Bits bits;
  std::memcpy(&row->first, reinterpret_cast<const char*>(&contact), sizeof(Doubles));
  std::memcpy(&bits, reinterpret_cast<const char*>(&contact) + sizeof(Doubles), sizeof(Doubles));
  row->second = reinterpret_cast<Doubles>(bits & NUMBERS);
}

}  // namespace blem_sim::reduction
