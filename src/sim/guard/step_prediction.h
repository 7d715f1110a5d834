// Longest next solve in which no boundary layer can be used up unseen [Hauser 2013, 3.3].
#pragma once

#include <vector>

#include "build/simulated_world.h"
#include "contacts/search/found_contacts.h"

namespace blem_sim::sim {

/**
 * A pair is in danger if its colliders, moving on as they do, could come so close within `time` that less than a tenth of the layer is left
 * between the bare meshes, or closer than their contacts are known. Their speed of approach is the largest relative speed, whatever its
 * direction, of their points where they may meet: features that pass beside each other are not foreseen by any contact. Over a half-space
 * it is the speed towards its plane. The solve then ends where the layers touch or, if they nearly do, after half a layer.
 * Pairs without a layer, and pairs that are far from each other or slow, ask for nothing.
 * @param contacts of the state at hand @param bodies its states, by slot @param time [s] that is left of the step
 * @return [s] at most `time`
 */
double safeTime(const SimulatedWorld& world, const FoundContacts& contacts, const std::vector<dynamics::BodyState>& bodies, double time);

}  // namespace blem_sim::sim
