// Poses and velocities as messages give them, in the frame of a model or a link.
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Twist.h>

#include <string>

#include "blem_sim/sim/link_motion.h"

namespace blem_sim::node {

/** Motion of the frame of a model or a link; of the world, which stands, for "", "world" and "map". @throws InputError */
sim::LinkMotion frameMotion(const sim::Simulator& simulator, const std::string& frame, const std::string& where);

/** Motion as seen from a frame: pose in it, difference of velocities in its axes. */
sim::LinkMotion seenFrom(const sim::LinkMotion& frame, const sim::LinkMotion& motion);

/** Motion in the world of what stands at a pose in a frame; the twist is in the frame's axes. @throws InputError: numbers that are none */
sim::LinkMotion inWorld(const sim::LinkMotion& frame, const geometry_msgs::Pose& pose, const geometry_msgs::Twist& twist,
                        const std::string& where);

/** State of a part's body when the part moves so. */
dynamics::BodyState bodyStateOf(const sim::Simulator& simulator, const sim::LinkPart& part, const sim::LinkMotion& motion);

}  // namespace blem_sim::node
