// Every link and joint that a robot's configuration names must exist.
#pragma once

#include "blem_sim/model/robot_model.h"
#include "blem_sim/sim/config.h"

namespace blem_sim::sim {

/** @throws InputError naming the entry, the unknown name and the nearest known one */
void checkRobotNames(const RobotConfig& config, const model::RobotModel& model, const model::LumpedRobot& lumped);

}  // namespace blem_sim::sim
