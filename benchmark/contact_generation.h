// Times of contact generation on the scenes of contact_scenes.h, and of what bounds it from above and below.
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

/** What a search for pairs takes, and how many it finds; means over some poses of the scene. */
struct PairSearch {
  double microseconds = 0, pairs = 0;
};

/** A plain tree that lists the pairs of triangles within reach: trees of all colliders, then some steps. */
PairSearch searchPlainly(const ContactScene& scene);

/** The steps at which what hardly varies is timed. */
std::vector<int> sampledSteps();

}  // namespace blem_sim
