#include "loop/logger_services.h"

#include <ros/console.h>
#include <ros/console_impl.h>
#include <ros/service_manager.h>
#include <roscpp/GetLoggers.h>

#include <string>
#include <utility>

namespace blem_sim::node {

namespace {

const char* const LOGGERS[] = {ROSCONSOLE_ROOT_LOGGER_NAME, ROSCONSOLE_DEFAULT_NAME, "ros.roscpp", "ros.roscpp.superdebug"};
const std::pair<ros::console::Level, const char*> LEVELS[] = {{ros::console::levels::Debug, "debug"},
                                                              {ros::console::levels::Info, "info"},
                                                              {ros::console::levels::Warn, "warn"},
                                                              {ros::console::levels::Error, "error"},
                                                              {ros::console::levels::Fatal, "fatal"}};

/** Name of the lowest level that a logger lets pass. */
std::string levelOf(const std::string& logger) {
  void* const handle = ros::console::impl::getHandle(logger);
  for (const auto& [level, name] : LEVELS)
    if (ros::console::impl::isEnabledFor(handle, level)) return name;
  return "";
}

bool list(roscpp::GetLoggers::Request&, roscpp::GetLoggers::Response& response) {
  for (const char* const name : LOGGERS) {
    roscpp::Logger logger;
    logger.name = name;
    logger.level = levelOf(name);
    response.loggers.push_back(logger);
  }
  return true;
}

}  // namespace

ros::ServiceServer advertiseLoggers(ros::NodeHandle private_node) {
  const std::string service = private_node.resolveName("get_loggers");
  ros::ServiceManager::instance()->unadvertiseService(service);
  return private_node.advertiseService(service, list);
}

}  // namespace blem_sim::node
