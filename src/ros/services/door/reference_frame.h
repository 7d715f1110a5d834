// Poses and velocities as messages give them, in the frame of a model or a link.
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Twist.h>

#include <string>

#include "messages/link_motion.h"

namespace blem_sim::node {

/** Motion of the frame of a model or a link; of the world, which stands, for "", "world" and "map". @throws InputError */
LinkMotion frameMotion(const sim::Simulator& simulator, const std::string& frame, const std::string& where);

/** Motion as seen from a frame: pose in it, difference of velocities in its axes. */
LinkMotion seenFrom(const LinkMotion& frame, const LinkMotion& motion);

/** Motion in the world of what stands at a pose in a frame; the twist is in the frame's axes. @throws InputError: numbers that are none */
LinkMotion inWorld(const LinkMotion& frame, const geometry_msgs::Pose& pose, const geometry_msgs::Twist& twist, const std::string& where);

/** State of a part's body when the part moves so. */
dynamics::BodyState bodyStateOf(const sim::Simulator& simulator, const sim::LinkPart& part, const LinkMotion& motion);

}  // namespace blem_sim::node
