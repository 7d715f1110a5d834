// Names of a robot's frames on /tf and in messages, and of what it listens to.
#pragma once

#include <string>

#include "blem_sim/sim/simulator_types.h"

namespace blem_sim::node {

/** Frame of a robot's link, or of what a sensor's name stands for: its tf_prefix before the name, as robot_state_publisher puts it. */
std::string ownFrame(const sim::RobotInfo& robot, const std::string& name);

/** Frame that a user named for a robot's messages: as ownFrame, but world, map, and what begins with / are no robot's. */
std::string namedFrame(const sim::RobotInfo& robot, const std::string& name);

/** The parameter tf_prefix that robot_state_publisher finds in a name space or above it; empty if there is none. */
std::string tfPrefixIn(const std::string& name_space);

/** False for what roscpp takes for no name of a topic or namespace; private names, which begin with ~, are none either: nothing here is
 *  meant below the node. */
bool isRosName(const std::string& name);

bool hasJoint(const sim::RobotInfo& robot, const std::string& joint);
bool shareNamespace(const sim::RobotInfo& a, const sim::RobotInfo& b);

/** Name of a joint that two robots of one namespace both have, so that they would take each other's commands; empty if there is none. */
std::string sharedJoint(const sim::RobotInfo& a, const sim::RobotInfo& b);

}  // namespace blem_sim::node
