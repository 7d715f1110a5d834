// The service that lists loggers, for rqt_logger_level and rosconsole.
#pragma once

#include <ros/node_handle.h>

namespace blem_sim::node {

/**
 * Takes the place of roscpp's own ~get_loggers. With log4cxx of 0.13 and later, as in Debian 12, that one frees the table of loggers as it
 * answers, and the next message that is logged ends the program.
 */
ros::ServiceServer advertiseLoggers(ros::NodeHandle private_node);

}  // namespace blem_sim::node
