// Trees in a saved state.
#pragma once

#include "blem_sim/geometry/state_stream.h"
#include "scene/scene.h"
#include "trees/forest_motion.h"

namespace blem_sim::dynamics {

void saveTree(const Forest& forest, int tree, const ForestMotion& motion, geometry::StateWriter* writer);
void restoreTree(const Forest& forest, int tree, ForestMotion* motion, geometry::StateReader* reader);
/** Whether the bodies of the scene stand where the tree has them, but for rounding. */
bool standsAt(const Forest& forest, int tree, const ForestMotion& motion, const Scene& scene);

}  // namespace blem_sim::dynamics
