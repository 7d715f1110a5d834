// Prefix of a robot's frames, which keeps those of two robots of one URDF apart.
#pragma once

#include <string>
#include <vector>

#include "blem_sim/sim/simulator_types.h"

namespace blem_sim::sim {

/**
 * The prefix that the configuration gives, without slashes at its ends; the robot's name if frames of another robot would be called as its
 * own then, which a note tells.
 * @throws InputError if neither keeps them apart
 */
std::string framePrefix(const RobotConfig& config, const model::RobotModel& model, const std::vector<RobotInfo>& others,
                        std::vector<std::string>* notes);

}  // namespace blem_sim::sim
