// Models, links and joints by the names that users of Gazebo give them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "blem_sim/sim/simulator.h"

namespace blem_sim::sim {

struct JointPart {
  int robot = 0;
  int joint = 0;  ///< index into joint_names
};

/** Each throws InputError that names the nearest known name, after `where`. */
int findModel(const Simulator& simulator, const std::string& name, const std::string& where);
/** @param name "model::link"; without a model's name the first match */
LinkPart findLink(const Simulator& simulator, const std::string& name, const std::string& where);
/** @param name "model::joint"; without a model's name the first match */
JointPart findJoint(const Simulator& simulator, const std::string& name, const std::string& where);
/** Frame of a model or a link; nothing for the world: "", "world", "map". */
std::optional<LinkPart> findFrame(const Simulator& simulator, const std::string& name, const std::string& where);

/** All links of a model, the root link first. */
std::vector<LinkPart> linksOf(const Simulator& simulator, int model);
/** Whether gravity does not act on a link, as the Gazebo block of its URDF says. */
bool isWeightless(const Simulator& simulator, const LinkPart& part);
/** A part's name without its model's. */
std::string withoutModel(const std::string& name);

}  // namespace blem_sim::sim
