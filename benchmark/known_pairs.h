// The least that contact generation can take: the kernels alone, told which pairs of features have a contact.
#pragma once

#include "contact_generation.h"

namespace blem_sim {

/**
 * Turns the features of the known contacts into the other mesh's frame and runs the candidates' kernels on exactly the pairs of features
 * that have one, with warm caches. No search, no closer looks, nothing written down but the kernels' hits.
 */
PairSearch runKernelsOnKnownPairs(const ContactScene& scene);

}  // namespace blem_sim
