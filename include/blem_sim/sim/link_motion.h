// Pose and velocity of a link, from the state of the body it is part of.
#pragma once

#include "blem_sim/sim/named_parts.h"

namespace blem_sim::sim {

struct LinkMotion {
  Pose X_WL = Pose::Identity();
  Vector3 v_WL = Vector3::Zero();  ///< [m/s] of the link's origin, world axes
  Vector3 w_WL = Vector3::Zero();  ///< [rad/s] world axes
};

/** Motion of a link, an object or an environment now. */
LinkMotion partMotion(const Simulator& simulator, const LinkPart& part);

/** @param link index into the robot's description */
LinkMotion linkMotion(const Simulator& simulator, const StepReport& report, const RobotInfo& robot, int link);

/** Motion of a body's own frame. */
LinkMotion bodyMotion(const Simulator& simulator, const StepReport& report, int body);

/** Motion of a model: a robot's root link, the frame of an object's body, or an environment's geometry, which stands. */
LinkMotion modelMotion(const Simulator& simulator, const StepReport& report, int model);

}  // namespace blem_sim::sim
