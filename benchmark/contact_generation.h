// Times of contact generation on the scenes of contact_scenes.h, and of searches that bound it from above and below.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "contact_scenes.h"
#include "soak/figures.h"

namespace blem_sim {

/** Contacts of every moving collider in every step, processor time. */
struct Generation {
  StepTimes times;
  double contacts = 0;  ///< per step, mean
};

/**
 * @param steps of the scene, from its first on; one more before them fills the memory and is not timed
 * @param remembers whether every pair has a memory of its steps before
 */
Generation generate(const ContactScene& scene, bool remembers, int steps);

/** Time of a search for pairs, and the number it finds; means over some poses of the scene. */
struct PairSearch {
  double microseconds = 0, pairs = 0;
};

/** A plain tree that lists the pairs of triangles within reach: trees of all colliders, then some steps. */
PairSearch searchPlainly(const ContactScene& scene);

/** Sampled steps, for times that hardly vary from step to step. */
std::vector<int> sampledSteps();

}  // namespace blem_sim
