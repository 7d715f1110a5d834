// Pairs of colliders outside their boundary layers, and events when they change.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "blem_sim/contact/collider.h"
#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/sim/step_report.h"
#include "contacts/search/found_contacts.h"

namespace blem_sim::sim {

/** Remembers the pairs that are outside, so that every change is told once; part of the simulation's state. */
class LayerWatch {
 public:
  /**
   * Appends the events of pairs that changed, in order of the pairs.
   * @param found contacts of the state at `time` [s]
   * @param passed pairs that used up their layers on the way from there to the next state, whatever its contacts; sorted
   */
  void look(const FoundContacts& found, const std::vector<std::pair<int, int>>& passed, double time, std::vector<LayerEventReport>* events);
  /** Forgets all pairs: none is outside. */
  void clear() { outside_.clear(); }
  /** Forgets the pairs of a collider whose slot another one may take; no event tells it. */
  void forget(int collider);
  void save(geometry::StateWriter* writer) const;
  /** @param colliders whose pairs they may be */
  void restore(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader);

 private:
  void addPassed(const FoundContacts& found, const std::vector<std::pair<int, int>>& passed, double time, std::size_t first,
                 std::vector<LayerEventReport>* events);

  std::vector<std::pair<int, int>> outside_;       // sorted
  std::vector<std::pair<int, int>> next_outside_;  // work space of look
};

}  // namespace blem_sim::sim
