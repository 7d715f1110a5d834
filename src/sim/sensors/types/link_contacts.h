// Contacts of each link of a robot, found once for all sensors that ask.
#pragma once

#include <vector>

#include "blem_sim/sim/step_report.h"
#include "build/simulated_world.h"

namespace blem_sim::sim {

/** Wrench of a step's contact on a link [N, N m], about a point at the start of the step, world axes. */
Wrench wrenchOfContact(const ContactReport& contact, bool on_a, const Vector3& p_WO);

class LinkContacts {
 public:
  /** A contact on a link; of one between two links there are two. */
  struct Entry {
    int model, link;
    int contact;  ///< index into the contacts
    bool on_a;    ///< the link is A's
  };
  /** Entries in order of contacts. */
  struct Range {
    const Entry *first, *last;
    const Entry* begin() const { return first; }
    const Entry* end() const { return last; }
  };

  /** Takes a step's contacts; those taken before are forgotten. */
  void index(const SimulatedWorld& world, const std::vector<ContactReport>& contacts);
  /** Contacts of a link alone, not of the links that are rigidly joined to it. Precondition: index() */
  Range of(int model, int link) const;

 private:
  std::vector<Entry> entries_;  // sorted by model, link, contact
};

}  // namespace blem_sim::sim
