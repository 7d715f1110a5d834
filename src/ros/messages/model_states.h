// States of many links or models as a message.
#pragma once

#include <blem_sim/ModelStates.h>

#include <string>

#include "blem_sim/sim/link_motion.h"
#include "messages/conversions.h"

namespace blem_sim::node {

/** @tparam States LinkStates or ModelStates */
template <typename States>
void append(const std::string& name, const sim::LinkMotion& motion, States* states) {
  states->name.push_back(name);
  states->pose.push_back(toPose(motion.X_WL));
  states->twist.push_back(toTwist(motion.v_WL, motion.w_WL));
}

/** Appends the models that are there: robots, objects and environments. */
inline void appendModels(const sim::Simulator& simulator, const sim::StepReport& report, ModelStates* states) {
  const int models = static_cast<int>(simulator.models().size());
  for (int model = 0; model < models; ++model) {
    const sim::ModelInfo& info = simulator.models()[model];
    if (info.alive) append(info.name, modelMotion(simulator, report, model), states);
  }
}

}  // namespace blem_sim::node
