// A total order of contacts, so that no result depends on the order they came in.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"

namespace blem_sim::contact {

/** A direction that no mesh has: few contacts share a place along it. Unit, but for 1e-5. */
inline const Vector3 UNCOMMON_DIRECTION(0.5773, 0.6411, 0.5057);

/** Total order: by id, then point, normal, depth, trust. Precondition: finite. */
bool contactBefore(const Contact& a, const Contact& b);

/** Drops contacts with non-finite numbers or no direction, makes the normals unit length and sorts by contactBefore. */
void makeCanonical(std::vector<Contact>& contacts);

/** Drops contacts as makeCanonical does, and makes the normals unit length, in the order given. */
void makeUsable(std::vector<Contact>& contacts);

/** Sorts indices of contacts; keeps its room. */
class CanonicalOrder {
 public:
  /** Sorts by contactBefore. */
  void sort(const std::vector<Contact>& contacts, std::vector<int>* indices);

 private:
  struct Key {
    std::uint64_t id;
    int index;
  };
  std::vector<Key> keys_;
};

}  // namespace blem_sim::contact
