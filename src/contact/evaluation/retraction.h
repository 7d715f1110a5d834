// The fallback where bare meshes cross [Hauser 2013, Fig. 6 bottom].
#pragma once

#include <vector>

#include "evaluation/edge_crossing.h"

namespace blem_sim::contact {

/**
 * One contact per crossing: the shortest retraction among its candidates, which are the edge's end that is on the wrong side of the face
 * (its direction is the face's normal), and the edge over a border of the face where both edges' normal cones allow it. The right side is
 * the one where the crossing's place was when the pair was last apart; if that is unknown, the one of the smaller body's middle. The gap is
 * minus the retraction, bounded by half the smaller body. Contacts already there that point to the wrong side come from features that have
 * passed through; they are dropped.
 * @param X_FM_apart pose of the pair when it was last apart, or null
 */
void addRetractions(const MeshPair& pair, const Pose* X_FM_apart, const std::vector<Crossing>& crossings,
                    std::vector<FeatureContact>* contacts);

}  // namespace blem_sim::contact
