// Plain data of the rooms below as ROS messages.
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/Vector3.h>
#include <geometry_msgs/Wrench.h>
#include <ros/time.h>
#include <std_msgs/ColorRGBA.h>

#include <string>

#include "blem_sim/dynamics/world_types.h"
#include "blem_sim/geometry/types.h"
#include "blem_sim/sim/drawing.h"

namespace blem_sim::node {

/** Name of the frame that everything is simulated in. */
extern const char* const WORLD_FRAME;

/** @param seconds simulated; rounded to a nanosecond */
ros::Time toStamp(double seconds);

geometry_msgs::Vector3 toVector3(const Vector3& v);
geometry_msgs::Point toPoint(const Vector3& p);
geometry_msgs::Quaternion toQuaternion(const Quaternion& q);
geometry_msgs::Pose toPose(const Pose& X);
geometry_msgs::Transform toTransform(const Pose& X);
geometry_msgs::Wrench toWrench(const Vector3& force, const Vector3& torque);
std_msgs::ColorRGBA toColour(const sim::Colour& colour);  ///< opaque
geometry_msgs::Twist toTwist(const Vector3& linear, const Vector3& angular);

Vector3 fromVector3(const geometry_msgs::Vector3& message);
Vector3 fromPoint(const geometry_msgs::Point& message);

/**
 * Pose from a message; a quaternion of zeros is the identity, others are normalised.
 * @param source names the message in errors. @throws InputError: NaN, infinite
 */
Pose fromPose(const geometry_msgs::Pose& message, const std::string& source);

}  // namespace blem_sim::node
