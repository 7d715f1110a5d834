// Contacts that go on while the surface below them is exchanged.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/dynamics/world_types.h"

namespace blem_sim::sim {

/** Contacts with a surface, known to the solver, which finds them again on what is left of it under other ids. */
class CarriedContacts {
 public:
  /** @param surface, other colliders @param of_a the surface is the contact's A */
  void add(int surface, int other, const contact::Contact& contact, bool of_a);
  /** Those that are found again. @param remains collider that is left of the surface */
  dynamics::ContactRenames onto(int remains, const std::vector<contact::ContactManifold>& manifolds) const;

 private:
  struct Carried {
    int other;  // collider on the surface
    bool of_a;
    std::uint64_t id;  // as the world knows it
    Vector3 point, away;
  };
  std::vector<Carried> carried_;
};

}  // namespace blem_sim::sim
