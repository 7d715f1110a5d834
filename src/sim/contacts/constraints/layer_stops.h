// Stops of soft layers: once most of a layer is used up, the rigid bodies below it bear.
#pragma once

#include <cstdint>
#include <vector>

#include "blem_sim/contact/manifold.h"
#include "blem_sim/geometry/state_stream.h"
#include "blem_sim/reduction/reduction.h"

namespace blem_sim::sim {

/**
 * Rigid contacts below the springs of compliant surfaces, where STOP of the layer is used up: a contact answers f = k depth+ - d v+ up to
 * there, and does not go deeper whatever the force. They are chosen from all contacts that are so deep, before reduction and beside the
 * budgets, at most MOST per pair: in a jam a model may have more places that bear than contacts, and those left out would sink in turn.
 */
class LayerStops {
 public:
  static constexpr double STOP = 0.8;  ///< of the layer
  static constexpr double SEEN = 0.6;  ///< of the layer: a contact less deep gets to 0.9 at most in one solve that the step guard accepts
  static constexpr int MOST = 6;       ///< of a pair

  /** Call before the first pair of a reduction. */
  void start() { count_ = 0; }
  /** Stops of the next pair, in the order (a, b): its contacts with depths [m] beyond the stop. @param manifold before reduction */
  const std::vector<contact::Contact>& choose(const contact::ContactManifold& manifold, const reduction::Reduction& method,
                                              reduction::ReductionWorkspace* workspace);
  /** Call after the last pair: the next reduction goes on with the choices of this one. */
  void remember();

  void clear();
  /** Forgets the pairs of a collider whose slot another one may take. */
  void forget(int collider);
  /** Choices of the last reduction, by pairs. */
  const reduction::ReductionMemory& memory() const { return memory_; }
  /** Saves the choices: nothing if there are no stops, so they are the last words of a state. */
  void save(geometry::StateWriter* writer) const;
  /** @param colliders whose pairs they may be */
  void restore(const std::vector<contact::Collider>& colliders, geometry::StateReader* reader);

 private:
  reduction::ReductionMemory memory_;
  bool any_ = false;                             // in the memory
  std::vector<contact::Contact> deep_;           // of the pair at hand
  std::vector<contact::ContactManifold> stops_;  // pair by pair; beyond count_ there is only memory to be used again
  std::size_t count_ = 0;
};

}  // namespace blem_sim::sim
