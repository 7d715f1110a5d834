// Limits of joints that mimic others, against the range of the joint that they follow.
#pragma once

#include "blem_sim/model/robot_model.h"

namespace blem_sim::model {

/**
 * Bounds each joint that others follow to where their limits let it go, and says so in the notes; one that turned without end is REVOLUTE
 * from then on. Limits that would leave it no way, as
 * those of fingers that close at negative angles and have limits from 0 on, are not kept.
 */
void bringLimitsTogether(LumpedRobot* robot);

}  // namespace blem_sim::model
